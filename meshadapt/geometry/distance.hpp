/// @file
/// Distances to the simplices that boundaries are made of: segments, in 3D triangles as well.
#pragma once

#include <algorithm>
#include <array>

#include "ductile/meshadapt/vector.hpp"

namespace ductile::meshadapt {

/// The point of a segment that is closest to a point.
template <int Dim>
Vector<Dim> closest_point(const std::array<Vector<Dim>, 2>& segment, const Vector<Dim>& point) {
  const Vector<Dim> along = segment[1] - segment[0];
  const double length2 = dot(along, along);
  if (!(length2 > 0)) return segment[0];
  return segment[0] + std::clamp(dot(point - segment[0], along) / length2, 0.0, 1.0) * along;
}

/// The point of a triangle that is closest to a point: where it lies in the triangle's plane if
/// that is inside, else the closest of the sides.
inline Vector<3> closest_point(const std::array<Vector<3>, 3>& triangle, const Vector<3>& point) {
  const Vector<3> u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Vector<3> d = point - triangle[0], normal = cross(u, v);
  const double area2 = dot(normal, normal);
  if (area2 > 0) {
    const double at_u = dot(cross(d, v), normal), at_v = dot(cross(u, d), normal);
    if (at_u >= 0 && at_v >= 0 && at_u + at_v <= area2)
      return triangle[0] + (at_u / area2) * u + (at_v / area2) * v;
  }
  Vector<3> best = triangle[0];
  double least = dot(d, d);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<3> at = closest_point(std::array{triangle[i], triangle[(i + 1) % 3]}, point);
    const double square = dot(point - at, point - at);
    if (square < least) {
      least = square;
      best = at;
    }
  }
  return best;
}

}  // namespace ductile::meshadapt
