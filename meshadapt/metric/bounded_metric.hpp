/// @file
/// Clamps eigenvalues so that a semidefinite or infinite tensor becomes a metric.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

inline bool has_bounds(const SizeBounds& bounds) {
  return bounds.smallest > 0 || bounds.largest > 0 || bounds.anisotropy > 0;
}

/// A tensor that is no metric with its sizes within bounds, which may make it one. Eigenvalues that
/// are below 0 by no more than the rounding of a few digits count as 0. One that is indefinite, or
/// not finite, stays as it is.
template <int Dim>
Metric<Dim> within_bounds(const Metric<Dim>& tensor, const SizeBounds& bounds) {
  constexpr double digits = 1e-6, nothing = 1e-300;
  double scale = 0;
  for (const double component : tensor.m) {
    if (!std::isfinite(component)) return tensor;
    scale = std::max(scale, std::abs(component));
  }
  const double factor = scale > nothing ? scale : 1;  // so that products are numbers
  PrincipalAxes<Dim> axes = principal_axes((1 / factor) * tensor);
  const double largest = *std::max_element(axes.value.begin(), axes.value.end());
  for (double& value : axes.value) {
    if (value < -digits * largest) return tensor;
    value = factor * std::max(value, 0.0);
  }
  axes.value = bounded(axes.value, bounds);
  return compose(axes);
}

/// The metric with its sizes within bounds; itself if they hold.
template <int Dim>
Metric<Dim> with_bounded_sizes(Metric<Dim> metric, const SizeBounds& bounds) {
  if (!in_range(metric)) metric = within_bounds(metric, bounds);
  PrincipalAxes<Dim> axes = principal_axes(metric);
  const auto within = bounded(axes.value, bounds);
  if (within == axes.value) return metric;
  axes.value = within;
  return brought_into_range(compose(axes));
}

}  // namespace ductile::meshadapt
