/// @file
/// The two sides of the zero of a linear interpolant: their volumes and their connected parts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "levelset/cut_domain.hpp"

namespace ductile::meshadapt {

/// The volume of an element in which the linear interpolant is below a level.
template <int Dim>
double volume_below(const CutDomain<Dim>& domain, std::size_t element,
                    std::span<const double> value_of, double level) {
  std::array<double, Dim + 1> f;
  for (std::size_t i = 0; i <= Dim; ++i)
    f[i] = value_of[domain.mesh.corners_of[element][i]] - level;
  std::sort(f.begin(), f.end());
  const auto below = std::ranges::count_if(f, [](double x) { return x < 0; });
  const double all = domain.mesh.volume_of[element];
  if (below == 0 || below == Dim + 1) return below == 0 ? 0 : all;
  const auto part = [&](std::size_t i, std::size_t j) { return f[i] / (f[i] - f[j]); };
  if (below == 1 || below == Dim) {  // one corner is cut off
    const std::size_t tip = below == 1 ? 0 : Dim;
    double product = all;
    for (std::size_t i = 0; i <= Dim; ++i)
      if (i != tip) product *= part(tip, i);
    return below == 1 ? product : all - product;
  }
  constexpr std::size_t last = Dim;  // 3: a wedge, as three tetrahedra
  const double x = part(0, 2), y = part(0, last), z = part(1, 2), w = part(1, last);
  return all * (x * y + x * w * (1 - y) + (1 - x) * w * z);
}

/// The same for all split elements. Thread safety of this and the following: one caller; runs on
/// the executor.
template <int Dim>
double volume_below(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                    std::span<const double> value_of, double level) {
  return runtime::parallel_reduce(
      executor, domain.mesh.element_count(), 0.0,
      [&](std::size_t e) {
        return domain.is_split(static_cast<ElementId>(e)) ? volume_below(domain, e, value_of, level)
                                                          : 0.0;
      },
      std::plus<>());
}

struct RemovedParts {
  std::size_t count = 0;
  double volume = 0;
};

/// Stands for a value of 0 that counts as positive.
inline constexpr double tiny = std::numeric_limits<double>::min();

/// The connected parts of one side, by their lowest vertices. Vertices of the other side are parts
/// without volume.
struct SideParts {
  runtime::DisjointSets sets;
  std::vector<double> volume_of;          // of its split elements
  std::vector<double> most_of;            // its largest absolute value
  std::vector<std::uint32_t> borders_of;  // its facets on the border of a material
};

template <int Dim>
SideParts find_parts(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                     std::span<const double> value_of, bool plus) {
  const std::size_t n = value_of.size();
  SideParts parts{runtime::DisjointSets(executor, n), std::vector<double>(n),
                  std::vector<double>(n), std::vector<std::uint32_t>(n)};
  const auto is_here = [&](VertexId v) { return (value_of[v] < 0) != plus; };
  const auto each_element = [&](auto&& visit) {
    for (ElementId e = 0; e < domain.mesh.element_count(); ++e) {
      const auto& corners = domain.mesh.corners_of[e];
      const auto first = std::ranges::find_if(corners, is_here);
      if (first != corners.end() && domain.is_split(e)) visit(e, corners, *first);
    }
  };
  each_element([&](ElementId, const Corners<Dim>& corners, VertexId first) {
    for (const VertexId v : corners)
      if (is_here(v)) parts.sets.unite(first, v);
  });
  each_element([&](ElementId e, const Corners<Dim>& corners, VertexId first) {
    const VertexId part = parts.sets.lowest(first);
    const double below = volume_below(domain, e, value_of, 0);
    parts.volume_of[part] += plus ? domain.mesh.volume_of[e] - below : below;
    for (std::size_t i = 0; i <= Dim; ++i)
      parts.borders_of[part] +=
          domain.is_border(e, i) &&
          std::ranges::all_of(facet_of<Dim>(corners, static_cast<int>(i)), is_here);
    for (const VertexId v : corners)
      if (is_here(v)) parts.most_of[part] = std::max(parts.most_of[part], std::abs(value_of[v]));
  });
  return parts;
}

/// Changes the sign of the values in connected parts of one side that have less than a volume; and
/// in those that are nothing but zeros and have many facets on the border of a material: there the
/// surface lies on the border.
template <int Dim>
RemovedParts remove_parts(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                          std::vector<double>& value_of, bool plus, double least_volume) {
  constexpr std::uint32_t many = 8;
  auto [sets, volume_of, most_of, borders_of] = find_parts(executor, domain, value_of, plus);
  RemovedParts removed;
  for (VertexId v = 0; v < value_of.size(); ++v) {
    const VertexId part = sets.lowest(v);
    const bool is_small = volume_of[part] > 0 && volume_of[part] < least_volume;
    if (!is_small && (most_of[part] > tiny || borders_of[part] < many)) continue;
    value_of[v] = -value_of[v];
    if (part != v || !is_small) continue;
    ++removed.count;
    removed.volume += volume_of[part];
  }
  return removed;
}

/// Makes values of 0 positive, and removes small parts: first where values are positive, then where
/// they are negative.
template <int Dim>
RemovedParts choose_sides(const runtime::Executor& executor, const CutDomain<Dim>& domain,
                          std::vector<double>& value_of, double least_volume) {
  if (std::ranges::find(value_of, 0.0) == value_of.end() && least_volume == 0) return {};
  std::ranges::replace(value_of, 0.0, tiny);
  const auto above = remove_parts(executor, domain, value_of, true, least_volume);
  if (least_volume == 0) return above;
  const auto below = remove_parts(executor, domain, value_of, false, least_volume);
  return {above.count + below.count, above.volume + below.volume};
}

}  // namespace ductile::meshadapt
