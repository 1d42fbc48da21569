#include "metric/demand.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/unit.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/wording.hpp"
#include "metric/interpolation.hpp"

namespace ductile::meshadapt {
namespace {

/// The logarithm of sqrt(det metric), elements in a unit of volume; no less than it is.
template <int Dim>
double log_density(const Metric<Dim>& metric) {
  double trace = 0;
  for (int i = 0; i < Dim; ++i) trace += metric(i, i);
  return (std::log(determinant(1 / trace * metric)) + Dim * std::log(trace)) / 2;
}

std::string with_commas(double number) {
  std::string digits = std::to_string(std::llround(number));
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace

template <int Dim, int Space>
double complexity_of_demand(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                            const std::vector<Metric<Space>>& metric_of) {
  std::vector<double> density_of;
  if constexpr (Dim == Space) {
    density_of = runtime::make_vector<double>(executor, metric_of.size());
    runtime::parallel_for(executor, metric_of.size(),
                          [&](std::size_t v) { density_of[v] = log_density(metric_of[v]); });
  }
  const auto of_element = [&](std::size_t e) {
    CornerPlaces<Dim, Space> corner;
    LogDensities<Dim> densities;
    const Corners<Dim>& corners = mesh.corners_of[e];
    for (std::size_t c = 0; c <= Dim; ++c) corner[c] = mesh.site_of[corners[c]].position;
    for (std::size_t c = 0; c <= Dim; ++c)
      if constexpr (Dim == Space)
        densities[c] = density_of[corners[c]];
      else
        densities[c] = log_density_in_plane(metric_of[corners[c]], unit(facet_normal(corner)));
    return complexity_of_element<Dim>(densities, corner);
  };
  return runtime::parallel_reduce(executor, mesh.element_slots(), 0.0, of_element, std::plus<>());
}

template <int Dim, int Space>
double share_of_steep(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh) {
  struct Complexity {
    double all = 0, of_steep = 0;
  };
  const auto of_element = [&](std::size_t e) {
    CornerPlaces<Dim, Space> corner;
    LogDensities<Dim> densities;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const Site<Space>& site = mesh.site_of[mesh.corners_of[e][i]];
      corner[i] = site.position;
      densities[i] = 0.5 * Dim * std::log(site.scale);
    }
    const double all = complexity_of_element<Dim>(densities, corner);
    return Complexity{all, is_steep<Dim>(densities, corner) ? all : 0};
  };
  const Complexity sum =
      runtime::parallel_reduce(executor, mesh.element_slots(), Complexity{}, of_element,
                               [](const Complexity& a, const Complexity& b) {
                                 return Complexity{a.all + b.all, a.of_steep + b.of_steep};
                               });
  return sum.of_steep / sum.all;
}

namespace {

/// The metric length of an edge by the metric that gives the smaller one.
template <int Dim>
double least_length(const Metric<Dim>& a, const Metric<Dim>& b, const Vector<Dim>& along) {
  return std::sqrt(std::min(squared_length(a, along), squared_length(b, along)));
}

/// The metric length of the edge in 2D, the area of the triangle in 3D, by the smallest of its
/// corners' metrics, in unit edges or unit triangles.
template <int Dim, int Space>
double unit_facets(const Mesh<Dim, Space>& mesh, const std::vector<Metric<Space>>& metric_of,
                   const Facet<Dim>& facet) {
  const auto at = [&](std::size_t i) { return mesh.site_of[facet[i]].position; };
  const Vector<Space> u = at(1) - at(0);
  if constexpr (Dim == 2) {
    return least_length(metric_of[facet[0]], metric_of[facet[1]], u);
  } else {
    const Vector<Space> v = at(2) - at(0);
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId corner : facet) {
      const Metric<Space>& metric = metric_of[corner];
      const double uu = squared_length(metric, u), vv = squared_length(metric, v),
                   uv = (squared_length(metric, u + v) - uu - vv) / 2;
      least = std::min(least, std::sqrt(std::max(uu * vv - uv * uv, 0.0)) / 2);
    }
    return least / (std::sqrt(3.0) / 4);
  }
}

template <int Dim, int Space>
bool requires_something(const Mesh<Dim, Space>& mesh) {
  const auto required = [](const auto& part) { return part.required; };
  return std::any_of(mesh.patches.begin(), mesh.patches.end(), required) ||
         std::any_of(mesh.regions.begin(), mesh.regions.end(), required);
}

}  // namespace

template <int Dim, int Space>
double least_elements(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                      const std::vector<Metric<Space>>& metric_of) {
  if (requires_something(mesh)) return 0;
  struct Least {
    double edge = 0, facets = 0;
  };
  const auto of_element = [&](std::size_t e) {
    Least least;
    const Corners<Dim>& corners = mesh.corners_of[e];
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t j = 0; j < i; ++j)
        least.edge = std::max(least.edge, least_length(metric_of[corners[i]], metric_of[corners[j]],
                                                       mesh.site_of[corners[i]].position -
                                                           mesh.site_of[corners[j]].position));
    for (std::size_t i = 0; i <= Dim; ++i)
      if (mesh.patches_of[e][i] != 0)
        least.facets +=
            unit_facets<Dim, Space>(mesh, metric_of, facet_of<Dim>(corners, static_cast<int>(i)));
    return least;
  };
  const Least all = runtime::parallel_reduce(
      executor, mesh.element_slots(), Least{}, of_element, [](const Least& a, const Least& b) {
        return Least{std::max(a.edge, b.edge), a.facets + b.facets};
      });
  return std::max(all.edge / 2, all.facets / (2 * (Dim + 1)));
}

void expect_countable(const std::string& name, int dimension, double elements) {
  constexpr double certain_share = 0.8;
  if (elements * certain_share > none)
    refuse(name + ": asks for about " + with_commas(std::min(elements, 1e18)) +
           (dimension == 2 ? " triangles" : " tetrahedra") +
           " on this mesh, and 32-bit numbers count at most 4,294,967,294; expected larger sizes"
           " (" +
           Wording("smallest_size bounds them", "-hmin sets the smallest") + ")");
}

void expect_room(const std::string& name, int dimension, double elements, std::size_t limit) {
  constexpr double certain_share = 0.8, certain_memory = 0.85;
  const double bytes_of_each = dimension == 2 ? 150 : 200;  // at the peak, docs/performance.md
  const double bytes = elements * bytes_of_each;
  if (bytes * certain_share * certain_memory <= static_cast<double>(limit)) return;
  constexpr double megabyte = 1 << 20U;
  throw Error(name + ": asks for about " + with_commas(elements) +
              (dimension == 2 ? " triangles" : " tetrahedra") +
              " on this mesh, which would take about " + with_commas(bytes / megabyte) +
              " MB of memory, and there are " + with_commas(static_cast<double>(limit) / megabyte) +
              " MB; expected larger sizes, or more memory");
}

template double complexity_of_demand(const runtime::Executor&, const Mesh<2>&,
                                     const std::vector<Metric<2>>&);
template double complexity_of_demand(const runtime::Executor&, const Mesh<2, 3>&,
                                     const std::vector<Metric<3>>&);
template double complexity_of_demand(const runtime::Executor&, const Mesh<3>&,
                                     const std::vector<Metric<3>>&);

template double least_elements(const runtime::Executor&, const Mesh<2>&,
                               const std::vector<Metric<2>>&);
template double least_elements(const runtime::Executor&, const Mesh<2, 3>&,
                               const std::vector<Metric<3>>&);
template double least_elements(const runtime::Executor&, const Mesh<3>&,
                               const std::vector<Metric<3>>&);

template double share_of_steep(const runtime::Executor&, const Mesh<2>&);
template double share_of_steep(const runtime::Executor&, const Mesh<2, 3>&);
template double share_of_steep(const runtime::Executor&, const Mesh<3>&);

}  // namespace ductile::meshadapt
