/// @file
/// How well two meshes cover each other.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

/// A smaller share of an element outside is rounding error.
inline constexpr double least_share = 1e-9;

struct Coverage {
  double volume_outside = 0;   // of the new mesh outside the old one
  double volume_left_out = 0;  // of the old mesh outside the new one
};

/// `covered`: the share of each new element's volume that old ones cover.
template <int Dim>
Coverage coverage(const runtime::Executor& executor, const FixedMesh<Dim>& old_mesh,
                  const FixedMesh<Dim>& new_mesh, const std::vector<double>& covered) {
  const auto sum = [&](std::size_t count, auto&& term) {
    return runtime::parallel_reduce(executor, count, 0.0, term, std::plus<>());
  };
  const double shared = sum(covered.size(), [&](std::size_t e) {
    return new_mesh.volume_of[e] * std::min(1.0, covered[e]);
  });
  const auto without = [&](const FixedMesh<Dim>& mesh) {
    const double all = sum(mesh.element_count(), [&](std::size_t e) { return mesh.volume_of[e]; });
    return all - shared > least_share * all ? all - shared : 0;
  };
  return {without(new_mesh), without(old_mesh)};
}

}  // namespace ductile::meshadapt
