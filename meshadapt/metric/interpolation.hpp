/// @file
/// How a metric goes on between the corners of an element that it is given at: log-Euclidean
/// interpolation, unless sizes differ so much that it would ask for many more elements than sizes
/// that grow linearly. Private to mesh adaptation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The logarithms of the metrics at an element's corners.
template <int Dim, int Space = Dim>
using CornerLogs = std::array<const Metric<Space>*, Dim + 1>;

/// The logarithm of sqrt(det metric) at each corner.
template <int Dim>
using LogDensities = std::array<double, Dim + 1>;

/// The logarithm of sqrt(det metric), of the logarithm of a metric.
template <int Dim>
double log_density_of_log(const Metric<Dim>& log_metric) {
  double trace = 0;
  for (int i = 0; i < Dim; ++i) trace += log_metric(i, i);
  return trace / 2;
}

/// The logarithm of sqrt(det metric) in the plane of a triangle with this normal, of unit length.
inline double log_density_in_plane(const Metric<3>& metric, const Vector<3>& normal) {
  const Metric<3> dual = inverse(metric);
  return std::log(determinant(metric) * squared_length(dual, normal)) / 2;
}

/// The positions of an element's corners.
template <int Dim, int Space = Dim>
using CornerPlaces = std::array<Vector<Space>, Dim + 1>;

/// Does the product of the sizes differ by a factor of more than 100 between the corners?
template <std::size_t Corners>
bool differ_much(const std::array<double, Corners>& log_densities) {
  constexpr double log_of_100 = 4.605170185988092;
  const auto [least, most] = std::minmax_element(log_densities.begin(), log_densities.end());
  return *most - *least > log_of_100;
}

/// And would sizes that grow exponentially between them ask for many elements in this one? Beside a
/// layer of 1e-5, in elements of 0.17, they ask for 2,000 across where sizes that grow linearly to
/// 0.03 ask for 40 (docs/decisions/0033). A mesh that shows how sizes change has no such elements.
template <int Dim, int Space>
bool is_steep(const LogDensities<Dim>& log_densities,
              const std::array<Vector<Space>, Dim + 1>& corner);

/// The integral of sqrt(det metric) over an element. Thread safety: any thread.
template <int Dim, int Space>
double complexity_of_element(const LogDensities<Dim>& log_densities,
                             const std::array<Vector<Space>, Dim + 1>& corner);

/// The directions of the log-Euclidean mean, with sizes that are the means of the corners' sizes,
/// the shortest with the shortest: from linear sizes alone, directions that differ by a little
/// would blur what is thin.
template <int Dim, int Space = Dim>
Metric<Space> with_linear_sizes(const Metric<Space>& log_mean, const CornerLogs<Dim, Space>& logs,
                                const std::array<double, Dim + 1>& weight) {
  std::array<double, Space> sizes{};
  for (std::size_t i = 0; i <= Dim; ++i) {
    std::array<double, Space> values = principal_axes(*logs[i]).value;
    std::sort(values.begin(), values.end());
    for (std::size_t k = 0; k < Space; ++k) sizes[k] += weight[i] * std::exp(-values[k] / 2);
  }
  PrincipalAxes<Space> axes = principal_axes(log_mean);
  std::array<std::size_t, Space> rising;
  std::iota(rising.begin(), rising.end(), std::size_t{0});
  std::sort(rising.begin(), rising.end(),
            [&](std::size_t a, std::size_t b) { return axes.value[a] < axes.value[b]; });
  for (std::size_t k = 0; k < Space; ++k) axes.value[rising[k]] = 1 / (sizes[k] * sizes[k]);
  return compose(axes);
}

/// The metric at a point of an element, whose barycentric weights add up to 1. Log-Euclidean means
/// are those of Arsigny, Fillard, Pennec & Ayache, SIAM J. Matrix Anal. Appl. 29, 2007. `places`
/// gives the CornerPlaces when it is called, which is seldom. Thread safety: any thread.
template <int Dim, int Space = Dim>
Metric<Space> interpolated(const CornerLogs<Dim, Space>& logs,
                           const std::array<double, Dim + 1>& weight, const auto& places) {
  Metric<Space> log_mean;
  LogDensities<Dim> densities;
  for (std::size_t i = 0; i <= Dim; ++i) {
    log_mean += weight[i] * *logs[i];
    densities[i] = log_density_of_log(*logs[i]);
    if constexpr (Dim < Space) densities[i] *= static_cast<double>(Dim) / Space;
  }
  if (differ_much(densities) && is_steep<Dim>(densities, places()))
    return with_linear_sizes<Dim, Space>(log_mean, logs, weight);
  return exponential(log_mean);
}

}  // namespace ductile::meshadapt
