/// @file
/// Whether the elements of a mesh that a caller made name vertices that there are.
#pragma once

#include <algorithm>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "mesh/first_bad.hpp"

namespace ductile::meshadapt {

template <int Dim>
bool names_others(const AnyMesh& mesh, std::size_t element) {
  const auto& corners = elements_in<Dim>(mesh).vertices[element];
  return std::any_of(corners.begin(), corners.end(),
                     [&](std::size_t v) { return v >= mesh.vertex_count(); });
}

template <int Dim>
[[noreturn]] void refuse_corners(const AnyMesh& mesh, std::size_t element) {
  throw InputError(mesh.name + ": " + entity(element_name<Dim>(), element) +
                   " names a vertex beyond the " + std::to_string(mesh.vertex_count()) +
                   " that there are");
}

/// Throws InputError, naming the first element that has a corner beyond the vertices.
template <int Dim>
void expect_corners(const runtime::Executor& executor, const AnyMesh& mesh) {
  const std::size_t bad =
      first_bad(executor, elements_in<Dim>(mesh).size(),
                [&](std::size_t element) { return names_others<Dim>(mesh, element); });
  if (bad != no_index) refuse_corners<Dim>(mesh, bad);
}

}  // namespace ductile::meshadapt
