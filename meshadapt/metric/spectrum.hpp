/// @file
/// Spectrum<Dim>: the axes and eigenvalues of a metric at each vertex, and what becomes of them
/// when all are multiplied by one factor and then bounded: complexity, a measure to fit, the
/// metric.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "metric/metric_range.hpp"

namespace ductile::meshadapt {

/// Throws InputError unless every bound is 0 or makes sense.
void expect_bounds(const SizeBounds& bounds);
/// Throws InputError unless a gradation is 0 or less, which is none, or 1 or more and finite. The
/// text begins with the option's name.
void expect_gradation(double factor, const char* option = "gradation");

/// Eigenvalues within the sizes and the anisotropy that the bounds allow.
template <std::size_t N>
std::array<double, N> bounded(std::array<double, N> value, const SizeBounds& bounds) {
  if (bounds.smallest > 0)
    for (double& v : value) v = std::min(v, 1 / (bounds.smallest * bounds.smallest));
  if (bounds.largest > 0)
    for (double& v : value) v = std::max(v, 1 / (bounds.largest * bounds.largest));
  if (bounds.anisotropy > 0) {
    const double finest = *std::max_element(value.begin(), value.end());
    for (double& v : value) v = std::max(v, finest / (bounds.anisotropy * bounds.anisotropy));
  }
  return value;
}

template <int Dim>
struct Spectrum {
  std::vector<PrincipalAxes<Dim>> axes_of;  // [vertex]
  SizeBounds bounds;

  std::array<double, Dim> scaled(std::size_t vertex, double factor) const {
    std::array<double, Dim> value = axes_of[vertex].value;
    for (double& v : value) v *= factor;
    return bounded(value, bounds);
  }

  /// `share_of` is that of a FixedMesh.
  double complexity(const runtime::Executor& executor, const std::vector<double>& share_of,
                    double factor) const {
    return runtime::parallel_reduce(
        executor, axes_of.size(), 0.0,
        [&](std::size_t v) {
          double determinant = 1;
          for (const double value : scaled(v, factor)) determinant *= value;
          return share_of[v] * std::sqrt(determinant);
        },
        std::plus<>());
  }

  std::vector<Metric<Dim>> metrics(const runtime::Executor& executor, double factor) const {
    std::vector<Metric<Dim>> metric_of(axes_of.size());
    runtime::parallel_for(executor, axes_of.size(), [&](std::size_t v) {
      PrincipalAxes<Dim> axes = axes_of[v];
      axes.value = scaled(v, factor);
      metric_of[v] = brought_into_range(compose(axes));
    });
    return metric_of;
  }
};

/// The factor at which a function that grows with it is `goal`; where it never is, the end at
/// which it is nearest. The function is about a power of the factor, but for parts where bounds
/// hold it. False position in logarithms, with bisection where that is slow.
template <class Function>
double fitting_factor(Function&& function, double goal, double guess) {
  constexpr double furthest = 1e40, close = 1e-10;
  const auto excess = [&](double log_factor) {
    const double value = function(std::exp(log_factor));
    return std::log(std::clamp(value / goal, 1e-200, 1e200));
  };
  double low = std::log(guess), high = low, low_excess = excess(low), high_excess = low_excess;
  const double start = low, limit = std::log(furthest);
  for (double step = 1; low_excess > 0 && low > start - limit; step *= 2) {
    high = low, high_excess = low_excess;
    low_excess = excess(low -= step);
  }
  for (double step = 1; high_excess < 0 && high < start + limit; step *= 2) {
    low = high, low_excess = high_excess;
    high_excess = excess(high += step);
  }
  if (low_excess > 0) return std::exp(low);
  if (high_excess < 0) return std::exp(high);
  for (int i = 0; i < 100 && high - low > close && high_excess - low_excess > close; ++i) {
    const double share = i % 3 == 2 ? 0.5 : -low_excess / (high_excess - low_excess);
    const double middle = low + share * (high - low);
    const double middle_excess = excess(middle);
    if (std::abs(middle_excess) < close) return std::exp(middle);
    (middle_excess < 0 ? low : high) = middle;
    (middle_excess < 0 ? low_excess : high_excess) = middle_excess;
  }
  return std::exp(std::abs(low_excess) < std::abs(high_excess) ? low : high);
}

}  // namespace ductile::meshadapt
