#include "levelset/small_components.hpp"

#include <algorithm>
#include <array>
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

template <int Dim>
RemovedComponents remove_from_side(const Executor& executor, const CutDomain<Dim>& domain,
                                   std::vector<double>& value_of, bool plus, double least_volume) {
  runtime::DisjointSets parts(executor, value_of.size());
  const auto is_here = [&](VertexId v) { return (value_of[v] < 0) != plus; };
  std::vector<double> volume_of(value_of.size());  // [lowest vertex of a part]
  std::vector<VertexId> first_of(domain.mesh.element_count(), none);
  runtime::parallel_for(executor, first_of.size(), [&](std::size_t e) {
    if (!domain.is_split(static_cast<ElementId>(e))) return;
    for (const VertexId v : domain.mesh.corners_of[e]) {
      if (!is_here(v)) continue;
      if (first_of[e] == none) first_of[e] = v;
      parts.unite(first_of[e], v);
    }
  });
  for (std::size_t e = 0; e < first_of.size(); ++e) {
    if (first_of[e] == none) continue;
    const double below = fraction_below(domain, e, value_of, 0);
    volume_of[parts.lowest(first_of[e])] += domain.mesh.volume_of[e] * (plus ? 1 - below : below);
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
template RemovedComponents remove_small_components(const Executor&, const CutDomain<2>&,
                                                   std::vector<double>&, double);
template RemovedComponents remove_small_components(const Executor&, const CutDomain<3>&,
                                                   std::vector<double>&, double);

}  // namespace ductile::meshadapt
