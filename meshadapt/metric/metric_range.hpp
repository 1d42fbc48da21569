/// @file
/// The range of valid metrics: positive definite, with sizes and an anisotropy within bounds.
/// Readers and writers use the same range, so that every written metric is read again. It leaves
/// room for the rounding of a metric of just the largest anisotropy.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"

namespace ductile::meshadapt {

/// How far sizes may be beyond their bounds, as a factor.
inline constexpr double range_tolerance = 1 + 1e-6;

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

/// Surely a metric: so are all but few, and it takes no eigenvalues.
template <int Dim>
bool surely_in_range(const Metric<Dim>& metric) {
  double trace = 0;
  for (int i = 0; i < Dim; ++i) trace += metric(i, i);
  return trace > 1e-90 && trace < 1e90 && eigenvalue_ratio_bound(metric) > 1e-12;
}

/// The first fault found in the eigenvalues of a tensor that should be a metric.
enum class RangeFault { nothing, indefinite, size, anisotropy };

template <std::size_t N>
RangeFault range_fault(const std::array<double, N>& eigenvalue) {
  double least = eigenvalue[0], most = eigenvalue[0];
  for (const double value : eigenvalue) {
    if (!(value > 0)) return RangeFault::indefinite;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  const double shortest = 1 / std::sqrt(most), longest = 1 / std::sqrt(least);
  if (!(shortest * range_tolerance >= smallest_size && longest <= largest_size * range_tolerance))
    return RangeFault::size;
  return longest > largest_anisotropy * range_tolerance * shortest ? RangeFault::anisotropy
                                                                   : RangeFault::nothing;
}

template <int Dim>
bool in_range(const Metric<Dim>& metric) {
  if (surely_in_range(metric)) return true;
  for (const double component : metric.m)
    if (!(std::abs(component) < 1e151)) return false;
  return range_fault(principal_axes(metric).value) == RangeFault::nothing;
}

/// The metric itself if it is one. If rounding, or an intersection, has made it more stretched than
/// metrics may be, one that is not: the longest sizes are shorter. What asks for sizes beyond their
/// bounds stays, to be refused, and so does what is no number.
template <int Dim>
Metric<Dim> brought_into_range(const Metric<Dim>& metric) {
  if (in_range(metric)) return metric;
  const PrincipalAxes<Dim> axes = principal_axes(metric);
  const double most = *std::max_element(axes.value.begin(), axes.value.end());
  if (!(most > 0 && most < 1e300)) return metric;
  const double highest = 1 / (smallest_size * smallest_size);
  const double lowest = 1 / (largest_size * largest_size);
  if (most > 1.01 * highest) return metric;
  for (const double value : axes.value)
    if (value < 0.99 * lowest && value > 1e-12 * most) return metric;
  // Rounding in turned axes takes some of the small ones again, so there is less stretch each time.
  Metric<Dim> result = metric;
  for (double ratio = 1 / (largest_anisotropy * largest_anisotropy); ratio < 1e-11; ratio *= 4) {
    PrincipalAxes<Dim> within = axes;
    for (double& value : within.value)
      value = std::clamp(std::max(value, ratio * most), lowest, highest);
    result = compose(within);
    if (in_range(result)) break;
  }
  return result;
}

}  // namespace ductile::meshadapt
