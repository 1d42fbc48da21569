/// @file
/// find_crossings(): the edges whose ends lie on different sides of the surface, and where on them
/// the function is 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/divide.hpp"
#include "levelset/level_set_gradients.hpp"

namespace ductile::meshadapt {

/// The edges of split elements whose ends have values of different sign, sorted by their vertices.
/// The function is linear along them. Thread safety of this and the following: one caller; runs on
/// the executor.
template <int Dim, int Space>
std::vector<Crossing> find_crossings(const runtime::Executor& executor,
                                     const CutDomain<Dim>& domain, std::span<const double> value_of,
                                     const std::vector<Vector<Space>>& place_of) {
  auto keys = runtime::parallel_collect<std::uint64_t>(
      executor, domain.mesh.element_count(), [&](std::size_t e, auto&& append) {
        const Corners<Dim>& corners = domain.mesh.corners_of[e];
        const auto below =
            std::ranges::count_if(corners, [&](VertexId v) { return value_of[v] < 0; });
        if (below == 0 || below == Dim + 1 || !domain.is_split(static_cast<ElementId>(e))) return;
        for (std::size_t k = 0; k < Simplex<Dim>::edge.size(); ++k) {
          const auto [a, b] = ends_of_edge<Dim>(corners, k);
          if ((value_of[a] < 0) != (value_of[b] < 0))
            append(std::uint64_t{std::min(a, b)} << 32U | std::max(a, b));
        }
      });
  runtime::parallel_sort<std::uint64_t>(executor, keys);
  keys.resize(runtime::parallel_unique<std::uint64_t>(executor, keys));
  std::vector<Crossing> crossings(keys.size());
  runtime::parallel_for(executor, keys.size(), [&](std::size_t i) {
    const auto a = static_cast<VertexId>(keys[i] >> 32U), b = static_cast<VertexId>(keys[i]);
    const Vector<Space> along = place_of[b] - place_of[a];
    crossings[i] = {a, b, value_of[a] / (value_of[a] - value_of[b]), dot(along, along)};
  });
  return crossings;
}

/// The zero of from (1 - t) + to t + bend t (1 - t), where |bend| < |to - from|: there is one.
inline double zero_of(double from, double to, double bend) {
  const double half = 0.5 * (to - from + bend);
  const double root = std::sqrt(std::max(0.0, half * half + bend * from));
  return std::clamp(-from / (half + std::copysign(root, half)), 0.0, 1.0);
}

/// Moves crossings to where the quadratic along the edge is 0 that has the function's values at the
/// ends and the difference of the slopes there, as in a LevelSetFunction.
template <int Dim>
void bend_crossings(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                    std::span<const double> function_of, std::span<Crossing> crossings) {
  constexpr double most_bend = 0.9;  // of the difference of the values; below 1, see zero_of()
  std::vector<VertexId> ends;
  for (const Crossing& edge : crossings) ends.insert(ends.end(), {edge.a, edge.b});
  runtime::parallel_sort<VertexId>(executor, ends);
  ends.resize(runtime::parallel_unique<VertexId>(executor, ends));
  const auto gradient_of = level_set_gradients<Dim>(executor, domain.mesh, function_of, ends);
  runtime::parallel_for(executor, crossings.size(), [&](std::size_t i) {
    auto& [a, b, t, square] = crossings[i];
    const Vector<Dim> along = domain.mesh.position_of[b] - domain.mesh.position_of[a];
    const auto slope = [&](VertexId v) {
      return dot(
          gradient_of[static_cast<std::size_t>(std::ranges::lower_bound(ends, v) - ends.begin())],
          along);
    };
    const double from = function_of[a], to = function_of[b];
    if (from * to >= 0) return;
    const double most = most_bend * std::abs(to - from);
    t = zero_of(from, to, std::clamp(0.5 * (slope(a) - slope(b)), -most, most));
  });
}

}  // namespace ductile::meshadapt
