/// @file
/// Plain vector geometry in double precision for the checker and the generators.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh.hpp"

namespace ductile::campaign {

inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator*(double f, const Point& a) { return {f * a[0], f * a[1], f * a[2]}; }
inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Point& a) { return std::sqrt(dot(a, a)); }

/// The bounding box of points, and its largest extent along an axis.
struct Box {
  Point low = {1e300, 1e300, 1e300}, high = {-1e300, -1e300, -1e300};

  void add(const Point& point) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  }
  double extent() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
  bool contains(const Point& point, double margin = 0) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (point[i] < low[i] - margin || point[i] > high[i] + margin) return false;
    return true;
  }
  bool meets(const Box& other) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (other.high[i] < low[i] || other.low[i] > high[i]) return false;
    return true;
  }
  /// Distance of the point to the box, 0 inside.
  double distance(const Point& point) const {
    Point gap;
    for (std::size_t i = 0; i < 3; ++i)
      gap[i] = std::max({low[i] - point[i], point[i] - high[i], 0.0});
    return norm(gap);
  }
};

inline Box box_of(const std::vector<Point>& points) {
  Box box;
  for (const Point& point : points) box.add(point);
  return box;
}

inline Box box_of(const Mesh& mesh, const Cell& cell) {
  Box box;
  for (const int vertex : cell)
    if (vertex >= 0) box.add(mesh.points[static_cast<std::size_t>(vertex)]);
  return box;
}

inline const Point& corner(const Mesh& mesh, const Cell& cell, std::size_t i) {
  return mesh.points[static_cast<std::size_t>(cell[i])];
}

/// Length, area or volume of a cell of 2, 3 or 4 corners; negative for inverted tetrahedra.
inline double measure(const Mesh& mesh, const Cell& cell) {
  const Point a = corner(mesh, cell, 1) - corner(mesh, cell, 0);
  if (cell[2] < 0) return norm(a);
  const Point b = corner(mesh, cell, 2) - corner(mesh, cell, 0);
  if (cell[3] < 0) return norm(cross(a, b)) / 2;
  return dot(cross(a, b), corner(mesh, cell, 3) - corner(mesh, cell, 0)) / 6;
}

inline Point centre(const Mesh& mesh, const Cell& cell) {
  Point sum = {0, 0, 0};
  int count = 0;
  for (const int vertex : cell)
    if (vertex >= 0) {
      sum = sum + mesh.points[static_cast<std::size_t>(vertex)];
      ++count;
    }
  return (1.0 / count) * sum;
}

inline double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point ab = b - a;
  const double square = dot(ab, ab);
  const double t = square > 0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
  return norm(p - (a + t * ab));
}

/// Distance to the nearest point of the triangle, including its interior.
inline double distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point normal = cross(b - a, c - a);
  const double length = norm(normal);
  const double rim = std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  if (!(length > 0)) return rim;
  const bool above = dot(cross(b - a, p - a), normal) >= 0 &&
                     dot(cross(c - b, p - b), normal) >= 0 && dot(cross(a - c, p - c), normal) >= 0;
  return above ? std::min(rim, std::abs(dot(p - a, normal)) / length) : rim;
}

/// The mesh, moved and scaled so that `box` starts at the origin and has an extent of 1.
inline Mesh normalised(Mesh mesh, const Box& box) {
  for (Point& point : mesh.points) point = point - box.low;
  const double extent = box.extent();
  for (Point& point : mesh.points)
    for (double& x : point) x /= extent;
  return mesh;
}

/// Rounding error of coordinates, relative to the extent.
inline double relative_rounding(const Box& box) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    largest = std::max({largest, std::abs(box.low[i]), std::abs(box.high[i])});
  return 2.3e-16 * largest / box.extent();
}

}  // namespace ductile::campaign
