/// @file
/// Checks that all values of a field, or coordinates of a mesh, are finite, before others are
/// computed from them.
#pragma once

#include <cmath>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

/// Throws InputError, naming the first, if a coordinate is infinite or not a number.
inline void expect_finite_coordinates(const runtime::Executor& executor, const AnyMesh& mesh) {
  const auto& x = mesh.coordinates;
  const std::size_t bad =
      first_bad(executor, x.size(), [&](std::size_t i) { return !std::isfinite(x[i]); });
  if (bad == no_index) return;
  refuse(name_of(mesh) + ": expected finite coordinates, found " + std::to_string(x[bad]) + " at " +
         Wording("coordinates[" + std::to_string(bad) + "]",
                 entity("vertex", bad / static_cast<std::size_t>(mesh.dimension))));
}

/// Throws InputError, naming the first vertex, if a value is infinite or not a number.
inline void expect_finite(const runtime::Executor& executor, const AnyField& field) {
  const std::size_t bad = first_bad(executor, field.values.size(),
                                    [&](std::size_t i) { return !std::isfinite(field.values[i]); });
  if (bad == no_index) return;
  const std::size_t vertex = bad / stride_of(field);
  refuse(name_of(field) + ": expected finite numbers, found " + std::to_string(field.values[bad]) +
         " at " +
         Wording("values[" + std::to_string(bad) + "], vertex " + std::to_string(vertex),
                 "vertex " + std::to_string(vertex + 1)) +
         "; correct the field there");
}

}  // namespace ductile::meshadapt
