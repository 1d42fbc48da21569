/// @file
/// Whether a tensor is a metric that meshes can be adapted to, and what bounds on sizes make of one
/// that is not: they say what holds where it asks for nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

/// A lower bound of smallest over largest eigenvalue that takes no iteration; 0 or not a number
/// where it says nothing. By det = product of eigenvalues and the arithmetic-geometric mean.
inline double eigenvalue_ratio_bound(const Metric<2>& m) {
  const double trace = m.m[0] + m.m[2];
  return m.m[0] > 0 ? determinant(m) / (trace * trace) : 0;
}
inline double eigenvalue_ratio_bound(const Metric<3>& m) {
  const double trace = m.m[0] + m.m[2] + m.m[5];
  const bool minors_positive = m.m[0] > 0 && m.m[0] * m.m[2] - m.m[1] * m.m[1] > 0;
  return minors_positive ? 4 * determinant(m) / (trace * trace * trace) : 0;
}

/// Positive definite, with sizes and anisotropy within reason.
template <int Dim>
bool is_metric(const Metric<Dim>& tensor) {
  double trace = 0;
  for (int i = 0; i < Dim; ++i) trace += tensor(i, i);
  if (trace > 1e-120 && trace < 1e120 && eigenvalue_ratio_bound(tensor) > 1e-12) return true;
  const auto values = principal_axes(tensor).value;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  if (!(*smallest > 0)) return false;
  const double shortest = 1 / std::sqrt(*largest), longest = 1 / std::sqrt(*smallest);
  return shortest >= smallest_size && longest <= largest_size &&
         longest <= largest_anisotropy * shortest;
}

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

}  // namespace ductile::meshadapt
