/// @file
/// The metric that an element has by itself, and how much of its stretch is meant.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The metric in which all edges of an element have length 1: over those of a regular one, the sum
/// of e e' is (d + 1)/2 times the identity, and both sides change alike under linear maps.
/// For a triangle in space, lengths across it are those of the longer axis in it.
template <int Dim, int Space>
Metric<Space> metric_of_element(const std::array<Vector<Space>, Dim + 1>& corner) {
  Metric<Space> sum;
  for (std::size_t i = 0; i <= Dim; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<Space> edge = corner[i] - corner[j];
      for (std::size_t column = 0, at = 0; column < Space; ++column)
        for (std::size_t row = 0; row <= column; ++row, ++at)
          sum.m[at] += edge.x[row] * edge.x[column];
    }
  PrincipalAxes<Space> axes = principal_axes(sum);
  // The small eigenvalues of elements as flat as rounding are arbitrary, even negative.
  const double least = 1e-15 * *std::max_element(axes.value.begin(), axes.value.end());
  for (double& value : axes.value) value = (Dim + 1) / (2 * std::max(value, least));
  if constexpr (Dim < Space) {  // the greatest is that across
    auto& value = axes.value;
    std::size_t across = 0;
    for (std::size_t i = 1; i < Space; ++i) across = value[i] > value[across] ? i : across;
    value[across] = std::min(value[(across + 1) % 3], value[(across + 2) % 3]);
  }
  return compose(axes);
}

/// A logarithm of a metric without the little stretch that isotropic meshes have by chance, where
/// sizes differ by less than a factor of 2; all of it is kept from a factor of 4 on. The
/// determinant stays.
template <int Dim>
Metric<Dim> without_little_stretch(const Metric<Dim>& log_metric) {
  PrincipalAxes<Dim> axes = principal_axes(log_metric);
  const auto [least, most] = std::minmax_element(axes.value.begin(), axes.value.end());
  const double log_stretch = (*most - *least) / 2;  // of sizes
  const double t = std::clamp(log_stretch / std::numbers::ln2 - 1, 0.0, 1.0);
  const double kept = t * t * (3 - 2 * t);
  const double mean = std::accumulate(axes.value.begin(), axes.value.end(), 0.0) / Dim;
  for (double& value : axes.value) value = mean + kept * (value - mean);
  return compose(axes);
}

}  // namespace ductile::meshadapt
