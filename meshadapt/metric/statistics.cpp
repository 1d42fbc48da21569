#include "ductile/meshadapt/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "core/quality.hpp"
#include "core/unit.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/indices.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/interpolation.hpp"
#include "metric/measure.hpp"

namespace ductile::meshadapt {

namespace {

using runtime::Executor;

/// Vertices with their metric; the identity where there is none.
template <int Dim>
std::vector<Site<Dim>> make_sites(const Executor& executor, const AnyMesh& mesh,
                                  const AnyField* metric) {
  constexpr std::size_t stride = Metric<Dim>::size;
  auto site_of = runtime::make_vector<Site<Dim>>(executor, mesh.vertex_count());
  runtime::parallel_for(executor, site_of.size(), [&](std::size_t v) {
    Metric<Dim> tensor = isotropic<Dim>(1);
    if (metric) std::copy_n(&metric->values[v * stride], stride, tensor.m.begin());
    site_of[v] = make_site(position_in<Dim>(mesh, v), tensor);
  });
  return site_of;
}

/// Signed area or volume, rounding and all; the area of a triangle in space.
template <int Dim, int Space>
double signed_measure(const std::array<const Site<Space>*, Dim + 1>& corner) {
  const Vector<Space> u = corner[1]->position - corner[0]->position;
  const Vector<Space> v = corner[2]->position - corner[0]->position;
  if constexpr (Dim < Space)
    return norm(cross(u, v)) / 2;
  else if constexpr (Dim == 2)
    return (u[0] * v[1] - u[1] * v[0]) / 2;
  else
    return dot(cross(u, v), corner[3]->position - corner[0]->position) / 6;
}

template <int Dim, int Space>
std::array<const Site<Space>*, Dim + 1> corners_of(const std::vector<Site<Space>>& site_of,
                                                   const Corners<Dim>& element) {
  std::array<const Site<Space>*, Dim + 1> corner;
  for (std::size_t i = 0; i < corner.size(); ++i) corner[i] = &site_of[element[i]];
  return corner;
}

/// Mean ratio in the mean metric. Rounding may make that of an ideal element a little more than 1;
/// it is reported as 1.
template <int Dim, int Space>
double quality_of(const std::array<const Site<Space>*, Dim + 1>& corner) {
  const auto [metric, scale] = mean_metric<Space>(corner);
  const double measure = signed_measure<Dim>(corner);
  double metric_measure;
  if constexpr (Dim < Space)
    metric_measure =
        std::sqrt(std::max(0.0, squared_area(metric, corner[1]->position - corner[0]->position,
                                             corner[2]->position - corner[0]->position))) /
        2;
  else
    metric_measure = metric_volume<Dim>(std::abs(measure), scale);
  const double ideal = Dim == 2 ? 4 * std::numbers::sqrt3 * metric_measure
                                : 12 * std::cbrt(9 * metric_measure * metric_measure);
  const double squares = sum_of_squared_lengths<Dim>(metric, corner);
  if (!(squares > 0)) return 0;  // all corners may be one point
  return std::copysign(std::min(ideal / squares, 1.0), measure);
}

/// Sets `found` to the vertices of a higher number to which edges lead, each once, in an order that
/// depends on the mesh alone. Thread safety: any thread.
template <int Dim>
void find_higher_neighbours(const VertexElements& lists, const std::vector<Corners<Dim>>& elements,
                            VertexId vertex, std::vector<VertexId>& found) {
  constexpr std::size_t few = 64;  // to be looked through for each
  found.clear();
  const auto is_new = [&](VertexId v) {
    return found.size() > few || std::find(found.begin(), found.end(), v) == found.end();
  };
  for (const ElementId element : lists.elements_of(vertex))
    for (const VertexId v : elements[element])
      if (v > vertex && is_new(v)) found.push_back(v);
  if (found.size() <= few) return;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

/// Metric length of an edge, the ends of which may be one point.
template <int Dim>
double length_of(const Site<Dim>& a, const Site<Dim>& b) {
  const EndSquares squares = end_squares(a, b);
  return squares.at_a + squares.at_b > 0 ? edge_length(squares) : 0;
}

/// The lengths of all edges, each counted once.
template <int Dim, int Space>
runtime::UnsetVector<double> edge_lengths(const AdjacentMesh& mesh,
                                          const std::vector<Site<Space>>& site_of) {
  const VertexElements& lists = mesh.lists<Dim>();
  const auto& elements = elements_in<Dim>(mesh.mesh()).vertices;
  runtime::PerThread<std::vector<VertexId>> found(mesh.executor());
  return runtime::parallel_collect<double>(
      mesh.executor(), site_of.size(), [&](std::size_t v, auto&& append) {
        std::vector<VertexId>& higher = found.mine();
        find_higher_neighbours<Dim>(lists, elements, static_cast<VertexId>(v), higher);
        for (const VertexId other : higher) append(length_of(site_of[v], site_of[other]));
      });
}

template <int Dim, int Space>
std::vector<double> qualities(const Executor& executor, const std::vector<Site<Space>>& site_of,
                              const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh).vertices;
  std::vector<double> quality_of_element(elements.size());
  runtime::parallel_for(executor, elements.size(), [&](std::size_t e) {
    quality_of_element[e] = quality_of<Dim>(corners_of<Dim>(site_of, elements[e]));
  });
  return quality_of_element;
}

/// Of sqrt(det metric), in the plane of a triangle in space.
template <int Dim, int Space>
double mean_density(const std::array<const Site<Space>*, Dim + 1>& corner) {
  double density = 0;
  [[maybe_unused]] Vector<Space> normal;
  if constexpr (Dim < Space)
    normal = unit(facet_normal({corner[0]->position, corner[1]->position, corner[2]->position}));
  for (const Site<Space>* site : corner) {
    if constexpr (Dim < Space)
      density += std::exp(log_density_in_plane(site->metric, normal)) / (Dim + 1);
    else
      density += metric_volume<Dim>(1, site->scale) / (Dim + 1);
  }
  return density;
}

template <int Dim, int Space>
double complexity_of(const Executor& executor, const std::vector<Site<Space>>& site_of,
                     const std::vector<Corners<Dim>>& elements) {
  return runtime::parallel_reduce(
      executor, elements.size(), 0.0,
      [&](std::size_t e) {
        const auto corner = corners_of<Dim>(site_of, elements[e]);
        const double measure = std::abs(signed_measure<Dim>(corner));
        return measure > 0 || Dim == Space ? measure * mean_density<Dim>(corner) : 0;
      },
      std::plus<>());
}

std::size_t count_if_below(const Executor& executor, std::span<const double> values, double bound) {
  return runtime::parallel_reduce(
      executor, values.size(), std::size_t{0},
      [&](std::size_t i) { return std::size_t{values[i] < bound}; }, std::plus<>());
}

template <int Dim, int Space = Dim>
MeshStatistics measure_in(const AdjacentMesh& adjacent, const AnyField* metric) {
  const Executor& executor = adjacent.executor();
  const AnyMesh& mesh = adjacent.mesh();
  const auto& elements = elements_in<Dim>(mesh).vertices;
  const std::vector<Site<Space>> site_of = make_sites<Space>(executor, mesh, metric);
  const runtime::UnsetVector<double> lengths = edge_lengths<Dim>(adjacent, site_of);

  MeshStatistics result;
  result.in_metric = metric != nullptr;
  result.quality = distribution(executor, qualities<Dim>(executor, site_of, mesh), 0, 1);
  if (metric) {
    result.complexity = complexity_of<Dim>(executor, site_of, elements);
    result.edges_short = count_if_below(executor, lengths, std::sqrt(0.5));
    const double past_long = std::nextafter(std::numbers::sqrt2, 2.0);
    result.edges_in_range = count_if_below(executor, lengths, past_long) - result.edges_short;
    result.edges_long = lengths.size() - result.edges_short - result.edges_in_range;
    result.edge_length = distribution(executor, lengths, 0, 3);
  } else {
    const double longest = lengths.empty() ? 1 : *std::max_element(lengths.begin(), lengths.end());
    result.edge_length = distribution(executor, lengths, 0, longest);
  }
  return result;
}

void expect_measurable(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  expect_coordinates(mesh);
  expect_finite_coordinates(executor, mesh);
  element_dimension(mesh) == 2 ? expect_corners<2>(executor, mesh)
                               : expect_corners<3>(executor, mesh);
  if (metric == nullptr) return;
  expect_field_of(*metric, mesh);
  if (metric->types != std::vector{AnyField::Type::symmetric})
    throw InputError(
        name_of(*metric) + ": expected a metric, one field of symmetric tensors, found " +
        (metric->types.size() == 1 ? "one of another type"
                                   : std::to_string(metric->types.size()) + " fields"));
  mesh.dimension == 2 ? expect_metric_field<2>(executor, *metric)
                      : expect_metric_field<3>(executor, *metric);
}

}  // namespace

std::vector<double> element_qualities(const Executor& executor, const AnyMesh& mesh,
                                      const AnyField* metric) {
  expect_measurable(executor, mesh, metric);
  if (mesh.dimension == 2)
    return qualities<2>(executor, make_sites<2>(executor, mesh, metric), mesh);
  const auto site_of = make_sites<3>(executor, mesh, metric);
  return is_surface(mesh) ? qualities<2>(executor, site_of, mesh)
                          : qualities<3>(executor, site_of, mesh);
}

MeshStatistics measure(const AdjacentMesh& mesh, const AnyField* metric) {
  expect_measurable(mesh.executor(), mesh.mesh(), metric);
  if (is_surface(mesh.mesh())) return measure_in<2, 3>(mesh, metric);
  return mesh.mesh().dimension == 2 ? measure_in<2>(mesh, metric) : measure_in<3>(mesh, metric);
}

MeshStatistics measure(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  return measure(AdjacentMesh(executor, mesh), metric);
}

}  // namespace ductile::meshadapt
