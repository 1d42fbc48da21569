/// @file
/// CurvedSimplex: a facet, or an edge, of a smooth model: a cubic Bézier curve, or a triangle of
/// such curves. Its sides depend on their own control points alone, so that two that share a side's
/// control points meet there without a gap.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// `Corners` is 2 for edges, 3 for triangles. A point of it is told by weights of the corners,
/// which sum up to 1 and are not negative.
template <int Dim, std::size_t Corners>
struct CurvedSimplex {
  using Weights = std::array<double, Corners>;

  /// [corner][corner]: the control point of the first corner towards the second; [i][i] is corner
  /// i.
  std::array<std::array<Vector<Dim>, Corners>, Corners> control;
  Vector<Dim> middle;  ///< the control point of the inside, of triangles only

  const Vector<Dim>& corner(std::size_t i) const { return control[i][i]; }

  /// The control point of a side that is straight and has constant speed.
  static Vector<Dim> even(const Vector<Dim>& from, const Vector<Dim>& to) {
    return from + (1.0 / 3) * (to - from);
  }

  /// How far the control points of a side are from where they lie if it is straight: the curve is
  /// within 3/4 of that of the straight side. The same, to the bit, for all that share the side.
  double bend(std::size_t i, std::size_t j) const {
    return std::max(norm(control[i][j] - even(corner(i), corner(j))),
                    norm(control[j][i] - even(corner(j), corner(i))));
  }

  Vector<Dim> at(const Weights& w) const {
    Vector<Dim> point;
    for (std::size_t i = 0; i < Corners; ++i)
      for (std::size_t j = 0; j < Corners; ++j)
        point += ((i == j ? 1 : 3) * w[i] * w[i] * w[j]) * control[i][j];
    if constexpr (Corners == 3) point += (6 * w[0] * w[1] * w[2]) * middle;
    return point;
  }

  /// By how much points change with the weights of the corners after the first, at the expense of
  /// the first.
  std::array<Vector<Dim>, Corners - 1> tangents(const Weights& w) const {
    std::array<Vector<Dim>, Corners> by{};
    for (std::size_t i = 0; i < Corners; ++i) {
      by[i] += (3 * w[i] * w[i]) * control[i][i];
      for (std::size_t j = 0; j < Corners; ++j)
        if (i != j) by[i] += (6 * w[i] * w[j]) * control[i][j] + (3 * w[j] * w[j]) * control[j][i];
      if constexpr (Corners == 3) by[i] += (6 * w[(i + 1) % 3] * w[(i + 2) % 3]) * middle;
    }
    std::array<Vector<Dim>, Corners - 1> result;
    for (std::size_t i = 1; i < Corners; ++i) result[i - 1] = by[i] - by[0];
    return result;
  }

  /// Weights closer to those of the closest point, by one step of Gauss and Newton, or none where
  /// that leads out of the simplex.
  std::optional<Weights> closer(const Weights& w, const Vector<Dim>& point) const {
    const auto by = tangents(w);
    const Vector<Dim> off = point - at(w);
    std::array<double, Corners - 1> step;
    if constexpr (Corners == 2) {
      step[0] = dot(off, by[0]) / dot(by[0], by[0]);
    } else {
      const double a = dot(by[0], by[0]), b = dot(by[0], by[1]), c = dot(by[1], by[1]);
      const double p = dot(off, by[0]), q = dot(off, by[1]), determinant = a * c - b * b;
      step = {(c * p - b * q) / determinant, (a * q - b * p) / determinant};
    }
    Weights result = w;
    for (std::size_t i = 1; i < Corners; ++i) {
      result[i] += step[i - 1];
      result[0] -= step[i - 1];
    }
    for (const double weight : result)
      if (!(weight >= 0)) return {};
    return result;
  }
};

}  // namespace ductile::meshadapt
