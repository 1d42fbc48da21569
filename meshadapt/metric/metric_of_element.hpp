/// @file
/// metric_of_element: the metric that an element has by itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The metric in which all edges of an element have length 1: over those of a regular one, the sum
/// of e e' is (d + 1)/2 times the identity, and both sides change alike under linear maps.
template <int Dim>
Metric<Dim> metric_of_element(const std::array<Vector<Dim>, Dim + 1>& corner) {
  Metric<Dim> sum;
  for (std::size_t i = 0; i <= Dim; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<Dim> edge = corner[i] - corner[j];
      for (std::size_t column = 0, at = 0; column < Dim; ++column)
        for (std::size_t row = 0; row <= column; ++row, ++at)
          sum.m[at] += edge.x[row] * edge.x[column];
    }
  PrincipalAxes<Dim> axes = principal_axes(sum);
  // The small eigenvalues of elements as flat as rounding are arbitrary, even negative.
  const double least = 1e-15 * *std::max_element(axes.value.begin(), axes.value.end());
  for (double& value : axes.value) value = (Dim + 1) / (2 * std::max(value, least));
  return compose(axes);
}

}  // namespace ductile::meshadapt
