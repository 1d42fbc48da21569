/// @file
/// Quadric: a surface of second degree through the origin that is closest to some points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// A height over the plane across a direction, d x + e y + a x^2 + b x y + c y^2, by weighted least
/// squares. With few points it bends as little as it can.
class Quadric {
 public:
  explicit Quadric(const Vector<3>& direction) : up_(direction) {}

  /// To be told of all points before any is added.
  void measure(const Vector<3>& offset) {
    const Vector<3> flat = offset - dot(offset, up_) * up_;
    if (dot(flat, flat) > dot(along_, along_)) along_ = flat;
    across_ = cross(up_, along_);
    for (std::size_t column = 0, at = 0; column < 3; ++column)
      for (std::size_t row = 0; row <= column; ++row)
        spread_.m[at++] += flat.x[row] * flat.x[column];
  }

  /// To be called then: goes along points that are stretched by more than 10, because there a slope
  /// towards far ones cannot be told from a bend across.
  void turn_along() {
    constexpr double stretched = 10;
    const PrincipalAxes<3> axes = principal_axes(spread_);
    std::array<std::size_t, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return axes.value[a] > axes.value[b]; });
    if (!(axes.value[order[0]] > stretched * stretched * axes.value[order[1]])) return;
    along_ = norm(along_) * axes.vector[order[0]];
    across_ = cross(up_, along_);
  }

  void add(const Vector<3>& offset, double weight) {
    const double scale = 1 / dot(along_, along_);
    const double x = scale * dot(offset, along_), y = scale * dot(offset, across_);
    const double height = dot(offset, up_) * std::sqrt(scale);
    const std::array<double, 5> term{x, y, x * x, x * y, y * y};
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * term[i] * term[j];
      right_[i] += weight * term[i] * height;
    }
  }

  /// At the origin, of unit length; the direction given where it would be turned too far from that.
  Vector<3> normal() {
    if (!solve()) return up_;
    const double length = norm(along_);
    Vector<3> result = up_ - (right_[0] / length) * along_ - (right_[1] / length) * across_;
    result *= 1 / norm(result);
    return dot(result, up_) > 0.8 ? result : up_;
  }

 private:
  /// Cholesky's decomposition, with each unknown scaled; second degrees are kept small.
  bool solve() {
    std::array<double, 5> scale{};
    for (std::size_t i = 0; i < 5; ++i) {
      if (!(matrix_[i][i] > 0)) return false;
      scale[i] = 1 / std::sqrt(matrix_[i][i]);
    }
    auto& m = matrix_;
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j <= i; ++j) m[i][j] *= scale[i] * scale[j];
      m[i][i] += i < 2 ? 1e-12 : 1e-6;
      right_[i] *= scale[i];
    }
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
        if (i == j && !(m[i][i] > 0)) return false;
        m[i][j] = i == j ? std::sqrt(m[i][i]) : m[i][j] / m[j][j];
      }
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t k = 0; k < i; ++k) right_[i] -= m[i][k] * right_[k];
      right_[i] /= m[i][i];
    }
    for (std::size_t i = 5; i-- > 0;) {
      for (std::size_t k = i + 1; k < 5; ++k) right_[i] -= m[k][i] * right_[k];
      right_[i] /= m[i][i];
    }
    for (std::size_t i = 0; i < 5; ++i) right_[i] *= scale[i];
    return true;
  }

  Vector<3> up_, along_, across_;
  Metric<3> spread_;
  std::array<std::array<double, 5>, 5> matrix_{};  // its lower triangle
  std::array<double, 5> right_{};
};

}  // namespace ductile::meshadapt
