/// @file
/// Symmetric tensors in the order of Field, as metrics: lengths of edges, sizes along axes.
#pragma once

#include <array>
#include <cmath>

#include "geometry.hpp"

namespace ductile::campaign {

using Tensor = std::array<double, 6>;  ///< xx xy yy xz yz zz; in 2D xz, yz are 0 and zz is 1

inline Tensor tensor_at(const Field& field, std::size_t i) {
  const double* value = &field.values[i * static_cast<std::size_t>(field.components)];
  if (field.components == 1) {
    const double m = 1 / (value[0] * value[0]);
    return {m, 0, m, 0, 0, field.dimension == 2 ? 1 : m};
  }
  if (field.components == 3) return {value[0], value[1], value[2], 0, 0, 1};
  return {value[0], value[1], value[2], value[3], value[4], value[5]};
}

/// e' M e.
inline double square_length(const Tensor& m, const Point& e) {
  return m[0] * e[0] * e[0] + m[2] * e[1] * e[1] + m[5] * e[2] * e[2] +
         2 * (m[1] * e[0] * e[1] + m[3] * e[0] * e[2] + m[4] * e[1] * e[2]);
}

inline double determinant(const Tensor& m) {
  return m[0] * (m[2] * m[5] - m[4] * m[4]) - m[1] * (m[1] * m[5] - m[4] * m[3]) +
         m[3] * (m[1] * m[4] - m[2] * m[3]);
}

/// The sum of the squares 1/h^2 along orthonormal axes with sizes h.
inline Tensor tensor_of(const std::array<Point, 3>& axes, const Point& sizes) {
  Tensor m = {0, 0, 0, 0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& a = axes[k];
    const double weight = 1 / (sizes[k] * sizes[k]);
    const Tensor add = {a[0] * a[0], a[0] * a[1], a[1] * a[1],
                        a[0] * a[2], a[1] * a[2], a[2] * a[2]};
    for (std::size_t i = 0; i < 6; ++i) m[i] += weight * add[i];
  }
  return m;
}

/// Logarithmic mean of an edge's lengths in the metrics at its ends.
inline double mean_length(double at_a, double at_b) {
  const double ratio = at_b / at_a;
  if (!(std::abs(ratio - 1) > 1e-6)) return 0.5 * (at_a + at_b);
  return (at_b - at_a) / std::log(ratio);
}

}  // namespace ductile::campaign
