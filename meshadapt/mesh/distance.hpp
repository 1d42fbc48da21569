/// @file
/// Distances to the simplices of boundaries: segments, and triangles in 3D.
#pragma once

#include <algorithm>
#include <array>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

/// The closest point of a segment.
template <int Dim>
Vector<Dim> closest_point(const std::array<Vector<Dim>, 2>& segment, const Vector<Dim>& point) {
  const Vector<Dim> along = segment[1] - segment[0];
  const double length2 = dot(along, along);
  if (!(length2 > 0)) return segment[0];
  return segment[0] + std::clamp(dot(point - segment[0], along) / length2, 0.0, 1.0) * along;
}

/// The closest point of a triangle: the projection to its plane if that is inside, otherwise the
/// closest point of the sides that it lies beyond.
inline Vector<3> closest_point(const std::array<Vector<3>, 3>& triangle, const Vector<3>& point) {
  const auto& [a, b, c] = triangle;
  const Vector<3> u = b - a, v = c - a, d = point - a, normal = cross(u, v);
  const double area2 = dot(normal, normal);
  const double at_b = dot(cross(d, v), normal), at_c = dot(cross(u, d), normal);
  const double at_a = area2 - at_b - at_c;  // weights, times the square of twice the area
  if (area2 > 0 && at_a >= 0 && at_b >= 0 && at_c >= 0)
    return a + (at_b / area2) * u + (at_c / area2) * v;
  Vector<3> best = a;
  double least = dot(d, d);
  const auto look_along = [&](const Vector<3>& from, const Vector<3>& to) {
    const Vector<3> at = closest_point(std::array{from, to}, point);
    const double square = dot(point - at, point - at);
    if (square < least) best = at;
    least = std::min(least, square);
  };
  if (!(at_a > 0)) look_along(b, c);
  if (!(at_b > 0)) look_along(c, a);
  if (!(at_c > 0)) look_along(a, b);
  return best;
}

}  // namespace ductile::meshadapt
