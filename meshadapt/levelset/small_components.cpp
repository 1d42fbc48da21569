#include "levelset/small_components.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// Fraction of an element's volume in which a linear function with these values at the corners is
/// below 0.
template <int Dim>
double fraction_below(std::array<double, Dim + 1> f) {
  std::sort(f.begin(), f.end());
  const auto below = std::count_if(f.begin(), f.end(), [](double x) { return x < 0; });
  if (below == 0) return 0;
  if (below == Dim + 1) return 1;
  const auto part = [&](std::size_t i, std::size_t j) { return f[i] / (f[i] - f[j]); };
  if (below == 1 || below == Dim) {  // one corner is cut off
    const std::size_t tip = below == 1 ? 0 : Dim;
    double product = 1;
    for (std::size_t i = 0; i <= Dim; ++i)
      if (i != tip) product *= part(tip, i);
    return below == 1 ? product : 1 - product;
  }
  if constexpr (Dim == 3) {  // a wedge, as three tetrahedra
    const double x = part(0, 2), y = part(0, 3), z = part(1, 2), w = part(1, 3);
    return x * y + x * w * (1 - y) + (1 - x) * w * z;
  }
  return 0;
}

template <int Dim>
double fraction_below(const CutDomain<Dim>& domain, std::size_t element,
                      std::span<const double> value_of, double level) {
  std::array<double, Dim + 1> f;
  for (std::size_t i = 0; i <= Dim; ++i)
    f[i] = value_of[domain.mesh.corners_of[element][i]] - level;
  return fraction_below<Dim>(f);
}

/// Unites the vertices of one side that are in one split element.
template <int Dim>
runtime::DisjointSets parts_of_side(const Executor& executor, const CutDomain<Dim>& domain,
                                    std::span<const double> value_of, bool plus) {
  runtime::DisjointSets parts(executor, value_of.size());
  runtime::parallel_for(executor, domain.mesh.element_count(), [&](std::size_t e) {
    if (!domain.is_split(static_cast<ElementId>(e))) return;
    VertexId first = none;
    for (const VertexId v : domain.mesh.corners_of[e]) {
      if ((value_of[v] < 0) == plus) continue;
      if (first != none) parts.unite(first, v);
      first = v;
    }
  });
  return parts;
}

template <int Dim>
RemovedComponents remove_from_side(const Executor& executor, const CutDomain<Dim>& domain,
                                   std::vector<double>& value_of, bool plus, double least_volume) {
  auto parts = parts_of_side(executor, domain, value_of, plus);
  std::vector<double> volume_of(value_of.size());  // [lowest vertex of a part]
  for (std::size_t e = 0; e < domain.mesh.element_count(); ++e) {
    const auto& corners = domain.mesh.corners_of[e];
    const auto v =
        std::ranges::find_if(corners, [&](VertexId u) { return (value_of[u] < 0) != plus; });
    if (v == corners.end() || !domain.is_split(static_cast<ElementId>(e))) continue;
    const double below = fraction_below(domain, e, value_of, 0);
    volume_of[parts.lowest(*v)] += domain.mesh.volume_of[e] * (plus ? 1 - below : below);
  }
  RemovedComponents removed;
  std::vector<VertexId> changing;
  for (VertexId v = 0; v < value_of.size(); ++v) {
    const double volume = volume_of[parts.lowest(v)];
    if (!(volume > 0 && volume < least_volume)) continue;
    if (parts.lowest(v) == v) {
      ++removed.count;
      removed.volume += volume;
    }
    changing.push_back(v);
  }
  for (const VertexId v : changing) value_of[v] = -value_of[v];
  return removed;
}

}  // namespace

template <int Dim>
double volume_below(const Executor& executor, const CutDomain<Dim>& domain,
                    std::span<const double> value_of, double level) {
  return runtime::parallel_reduce(
      executor, domain.mesh.element_count(), 0.0,
      [&](std::size_t e) {
        return domain.is_split(static_cast<ElementId>(e))
                   ? domain.mesh.volume_of[e] * fraction_below(domain, e, value_of, level)
                   : 0.0;
      },
      [](double a, double b) { return a + b; });
}

template <int Dim>
void count_zeros(const Executor& executor, const CutDomain<Dim>& domain,
                 std::vector<double>& value_of) {
  constexpr double tiny = std::numeric_limits<double>::min();
  constexpr std::uint32_t many_facets = 8;
  if (std::ranges::find(value_of, 0.0) == value_of.end()) return;
  std::vector<VertexId> zeros;
  for (VertexId v = 0; v < value_of.size(); ++v)
    if (value_of[v] == 0) zeros.push_back(v);
  for (const VertexId v : zeros) value_of[v] = tiny;
  auto parts = parts_of_side(executor, domain, value_of, true);
  std::vector<std::uint32_t> facets(value_of.size()), has_volume(value_of.size());  // [lowest]
  for (VertexId v = 0; v < value_of.size(); ++v)
    if (value_of[v] > tiny) has_volume[parts.lowest(v)] = 1;
  for (const VertexId v : zeros)
    for (const ElementId e : domain.mesh.elements_of(v))
      for (std::size_t i = 0; i <= Dim; ++i)
        if (domain.is_split(e) && domain.is_border(e, i) &&
            std::ranges::all_of(facet_of<Dim>(domain.mesh.corners_of[e], static_cast<int>(i)),
                                [&](VertexId u) { return value_of[u] == tiny; }))
          facets[parts.lowest(v)] += domain.mesh.corners_of[e][i] != v;
  for (const VertexId v : zeros)
    if (facets[parts.lowest(v)] >= Dim * many_facets && has_volume[parts.lowest(v)] == 0)
      value_of[v] = -tiny;
}

template <int Dim>
RemovedComponents remove_small_components(const Executor& executor, const CutDomain<Dim>& domain,
                                          std::vector<double>& value_of, double least_fraction) {
  if (!(least_fraction > 0)) return {};
  const double volume =
      std::accumulate(domain.mesh.volume_of.begin(), domain.mesh.volume_of.end(), 0.0);
  const auto above = remove_from_side(executor, domain, value_of, true, least_fraction * volume);
  const auto below = remove_from_side(executor, domain, value_of, false, least_fraction * volume);
  return {above.count + below.count, above.volume + below.volume};
}

template double volume_below(const Executor&, const CutDomain<2>&, std::span<const double>, double);
template double volume_below(const Executor&, const CutDomain<3>&, std::span<const double>, double);
template void count_zeros(const Executor&, const CutDomain<2>&, std::vector<double>&);
template void count_zeros(const Executor&, const CutDomain<3>&, std::vector<double>&);
template RemovedComponents remove_small_components(const Executor&, const CutDomain<2>&,
                                                   std::vector<double>&, double);
template RemovedComponents remove_small_components(const Executor&, const CutDomain<3>&,
                                                   std::vector<double>&, double);

}  // namespace ductile::meshadapt
