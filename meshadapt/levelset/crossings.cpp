#include "levelset/crossings.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "levelset/level_set_gradients.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim>
std::vector<Crossing> crossing_edges(const Executor& executor, const CutDomain<Dim>& domain,
                                     std::span<const double> value_of) {
  auto keys = runtime::parallel_collect<std::uint64_t>(
      executor, domain.mesh.element_count(), [&](std::size_t e, auto&& append) {
        const Corners<Dim>& corners = domain.mesh.corners_of[e];
        int below = 0;
        for (const VertexId v : corners) below += value_of[v] < 0;
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
  parallel_for(executor, keys.size(), [&](std::size_t i) {
    const auto a = static_cast<VertexId>(keys[i] >> 32U), b = static_cast<VertexId>(keys[i]);
    const Vector<Dim> along = domain.mesh.position_of[b] - domain.mesh.position_of[a];
    crossings[i] = {a, b, value_of[a] / (value_of[a] - value_of[b]), dot(along, along)};
  });
  return crossings;
}

/// The zero of from (1 - t) + to t + bend t (1 - t), where |bend| < |to - from|: there is one.
double zero_of(double from, double to, double bend) {
  const double half = 0.5 * (to - from + bend);
  const double root = std::sqrt(std::max(0.0, half * half + bend * from));
  return std::clamp(-from / (half + std::copysign(root, half)), 0.0, 1.0);
}

/// Moves zeros to where the quadratic along the edge is 0 that has the given values at its ends and
/// the difference of the slopes there, as in a LevelSetFunction.
template <int Dim>
void bend_zeros(const Executor& executor, const CutDomain<Dim>& domain,
                std::span<const double> function_of, std::vector<Crossing>& crossings) {
  constexpr double most_bend = 0.9;
  std::vector<VertexId> ends;
  ends.reserve(2 * crossings.size());
  for (const Crossing& edge : crossings) ends.insert(ends.end(), {edge.a, edge.b});
  runtime::parallel_sort<VertexId>(executor, ends);
  ends.resize(runtime::parallel_unique<VertexId>(executor, ends));
  const auto gradient_of = level_set_gradients<Dim>(executor, domain.mesh, function_of, ends);
  const auto gradient = [&](VertexId v) {
    return gradient_of[static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end(), v) -
                                                ends.begin())];
  };
  parallel_for(executor, crossings.size(), [&](std::size_t i) {
    Crossing& edge = crossings[i];
    const Vector<Dim> along = domain.mesh.position_of[edge.b] - domain.mesh.position_of[edge.a];
    const double from = function_of[edge.a], to = function_of[edge.b];
    const double at_a = dot(gradient(edge.a), along), at_b = dot(gradient(edge.b), along);
    const double bend = 0.5 * (at_a - at_b);
    if (from * to >= 0) return;
    const double most = most_bend * std::abs(to - from);
    edge.t = zero_of(from, to, std::clamp(bend, -most, most));
  });
}

}  // namespace

template <int Dim>
std::vector<Crossing> find_crossings(const Executor& executor, const CutDomain<Dim>& domain,
                                     std::span<const double> value_of,
                                     std::span<const double> function_of) {
  auto crossings = crossing_edges(executor, domain, value_of);
  if (!function_of.empty()) bend_zeros(executor, domain, function_of, crossings);
  return crossings;
}

template std::vector<Crossing> find_crossings(const Executor&, const CutDomain<2>&,
                                              std::span<const double>, std::span<const double>);
template std::vector<Crossing> find_crossings(const Executor&, const CutDomain<3>&,
                                              std::span<const double>, std::span<const double>);

}  // namespace ductile::meshadapt
