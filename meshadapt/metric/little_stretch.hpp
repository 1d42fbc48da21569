/// @file
/// without_little_stretch: which stretch of elements is meant, and which comes by chance.
#pragma once

#include <algorithm>
#include <numbers>
#include <numeric>

#include "ductile/meshadapt/metric.hpp"

namespace ductile::meshadapt {

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
