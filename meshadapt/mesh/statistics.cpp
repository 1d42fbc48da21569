#include "ductile/meshadapt/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "ductile/meshadapt/quality.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::meshadapt {

namespace {

using runtime::Executor;

/// Vertices with their metric; the identity where there is none.
template <int Dim>
std::vector<Site<Dim>> make_sites(const Executor& executor, const AnyMesh& mesh,
                                  const AnyField* metric) {
  constexpr std::size_t stride = Metric<Dim>::size;
  std::vector<Site<Dim>> site_of(mesh.vertex_count());
  runtime::parallel_for(executor, site_of.size(), [&](std::size_t v) {
    Metric<Dim> tensor = isotropic<Dim>(1);
    if (metric) std::copy_n(&metric->values[v * stride], stride, tensor.m.begin());
    site_of[v] = make_site(position_in<Dim>(mesh, v), tensor);
  });
  return site_of;
}

/// Signed area or volume, rounding and all.
template <int Dim>
double signed_measure(const std::array<const Site<Dim>*, Dim + 1>& corner) {
  const Vector<Dim> u = corner[1]->position - corner[0]->position;
  const Vector<Dim> v = corner[2]->position - corner[0]->position;
  if constexpr (Dim == 2)
    return (u[0] * v[1] - u[1] * v[0]) / 2;
  else
    return dot(cross(u, v), corner[3]->position - corner[0]->position) / 6;
}

template <int Dim>
std::array<const Site<Dim>*, Dim + 1> corners_of(const std::vector<Site<Dim>>& site_of,
                                                 const Corners<Dim>& element) {
  std::array<const Site<Dim>*, Dim + 1> corner;
  for (std::size_t i = 0; i < corner.size(); ++i) corner[i] = &site_of[element[i]];
  return corner;
}

/// Mean ratio in the metric of the densest corner, the mean over them where several are.
template <int Dim>
double quality_of(const std::array<const Site<Dim>*, Dim + 1>& corner) {
  const double measure = signed_measure<Dim>(corner);
  const double highest = densest<Dim>(corner).density;
  double sum = 0;
  int ties = 0;
  for (const Site<Dim>* judge : corner) {
    if (judge->density < highest * (1 - 1e-9)) continue;
    const double squares = sum_of_squared_lengths<Dim>(judge->metric, corner);
    const double metric_measure = std::abs(measure) * judge->density;
    sum += Dim == 2 ? 4 * std::numbers::sqrt3 * metric_measure / squares
                    : 12 * std::cbrt(9 * metric_measure * metric_measure) / squares;
    ++ties;
  }
  return std::copysign(sum / ties, measure);
}

/// Every edge once, as the lower vertex in the upper half and the higher in the lower one.
template <int Dim>
std::vector<std::uint64_t> unique_edges(const Executor& executor,
                                        const std::vector<Corners<Dim>>& elements) {
  constexpr std::size_t per_element = Simplex<Dim>::edges;
  std::vector<std::uint64_t> keys(elements.size() * per_element);
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (std::size_t i = 0; i < per_element; ++i) {
      const auto& ends = Simplex<Dim>::edge[i];
      const std::uint64_t a = elements[e][static_cast<std::size_t>(ends[0])];
      const std::uint64_t b = elements[e][static_cast<std::size_t>(ends[1])];
      keys[e * per_element + i] = std::min(a, b) << 32U | std::max(a, b);
    }
  });
  runtime::parallel_sort(executor, std::span(keys));
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  keys.shrink_to_fit();
  return keys;
}

template <int Dim>
std::vector<double> edge_lengths(const Executor& executor, const std::vector<Site<Dim>>& site_of,
                                 const std::vector<std::uint64_t>& edges) {
  std::vector<double> length_of(edges.size());
  runtime::parallel_for(executor, edges.size(), [&](std::size_t e) {
    length_of[e] = edge_length(site_of[edges[e] >> 32U], site_of[edges[e] & 0xffffffffU]);
  });
  return length_of;
}

template <int Dim>
std::vector<double> qualities(const Executor& executor, const std::vector<Site<Dim>>& site_of,
                              const std::vector<Corners<Dim>>& elements) {
  std::vector<double> quality_of_element(elements.size());
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    quality_of_element[e] = quality_of<Dim>(corners_of<Dim>(site_of, elements[e]));
  });
  return quality_of_element;
}

template <int Dim>
double complexity_of(const Executor& executor, const std::vector<Site<Dim>>& site_of,
                     const std::vector<Corners<Dim>>& elements) {
  return runtime::parallel_reduce(
      executor, elements.size(), 0.0,
      [&](std::size_t e) {
        const auto corner = corners_of<Dim>(site_of, elements[e]);
        double density = 0;
        for (const Site<Dim>* site : corner) density += site->density / (Dim + 1);
        return std::abs(signed_measure<Dim>(corner)) * density;
      },
      [](double a, double b) { return a + b; });
}

std::size_t count_if_below(const Executor& executor, const std::vector<double>& values,
                           double bound) {
  return runtime::parallel_reduce(
      executor, values.size(), std::size_t{0},
      [&](std::size_t i) { return std::size_t{values[i] < bound}; },
      [](std::size_t a, std::size_t b) { return a + b; });
}

template <int Dim>
MeshStatistics measure_in(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  const auto& elements = elements_in<Dim>(mesh).vertices;
  std::vector<std::uint64_t> edges = unique_edges<Dim>(executor, elements);  // takes most memory
  const std::vector<Site<Dim>> site_of = make_sites<Dim>(executor, mesh, metric);
  std::vector<double> lengths = edge_lengths<Dim>(executor, site_of, std::exchange(edges, {}));

  MeshStatistics result;
  result.in_metric = metric != nullptr;
  result.quality = distribution(executor, qualities<Dim>(executor, site_of, elements), 0, 1);
  if (metric) {
    result.complexity = complexity_of<Dim>(executor, site_of, elements);
    result.edges_short = count_if_below(executor, lengths, std::sqrt(0.5));
    const double past_long = std::nextafter(std::numbers::sqrt2, 2.0);
    result.edges_in_range = count_if_below(executor, lengths, past_long) - result.edges_short;
    result.edges_long = lengths.size() - result.edges_short - result.edges_in_range;
    result.edge_length = distribution(executor, std::move(lengths), 0, 3);
  } else {
    const double longest = lengths.empty() ? 1 : *std::max_element(lengths.begin(), lengths.end());
    result.edge_length = distribution(executor, std::move(lengths), 0, longest);
  }
  return result;
}

/// The smallest of the sorted values that at least this share of them do not exceed.
double percentile(std::span<const double> sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

}  // namespace

Distribution distribution(const Executor& executor, std::vector<double> values, double from,
                          double to) {
  Distribution result;
  result.histogram_from = from;
  result.histogram_to = to;
  result.count = values.size();
  if (values.empty()) return result;
  result.mean = runtime::parallel_reduce(
                    executor, values.size(), 0.0, [&](std::size_t i) { return values[i]; },
                    [](double a, double b) { return a + b; }) /
                static_cast<double>(values.size());
  runtime::parallel_sort(executor, std::span(values));
  result.min = values.front();
  result.low = percentile(values, 0.01);
  result.median = percentile(values, 0.5);
  result.max = values.back();
  const double width = (to - from) / static_cast<double>(result.histogram.size());
  auto begin = std::lower_bound(values.begin(), values.end(), from);
  result.below = static_cast<std::size_t>(begin - values.begin());
  for (std::size_t bin = 0; bin < result.histogram.size(); ++bin) {
    const bool last = bin + 1 == result.histogram.size();
    const double bound = last ? to : from + width * static_cast<double>(bin + 1);
    const auto end = last ? std::upper_bound(begin, values.end(), bound)
                          : std::lower_bound(begin, values.end(), bound);
    result.histogram[bin] = static_cast<std::size_t>(end - begin);
    begin = end;
  }
  result.above = static_cast<std::size_t>(values.end() - begin);
  return result;
}

std::vector<double> element_qualities(const Executor& executor, const AnyMesh& mesh,
                                      const AnyField* metric) {
  if (mesh.dimension == 2)
    return qualities<2>(executor, make_sites<2>(executor, mesh, metric),
                        elements_in<2>(mesh).vertices);
  return qualities<3>(executor, make_sites<3>(executor, mesh, metric),
                      elements_in<3>(mesh).vertices);
}

MeshStatistics measure(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  return mesh.dimension == 2 ? measure_in<2>(executor, mesh, metric)
                             : measure_in<3>(executor, mesh, metric);
}

}  // namespace ductile::meshadapt
