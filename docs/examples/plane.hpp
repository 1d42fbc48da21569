/// @file
/// Triangulations of points with integer coordinates, for the examples: the two exact predicates of
/// Delaunay algorithms, and a check of the result. in_circle computes in doubles, and in 128-bit
/// integers if the result does not exceed the possible error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace example {

using VertexId = std::uint32_t;
using TriangleId = std::uint32_t;
constexpr TriangleId outside = 0xffffffffU;

/// Coordinates are from 0 to 2^24, so that differences, their products and sums of two of those are
/// exact in doubles.
struct Point {
  std::int32_t x, y;
  friend auto operator<=>(const Point&, const Point&) = default;
};

/// Twice the area of a triangle, positive if its corners go anticlockwise. Exact.
inline std::int64_t turn(Point a, Point b, Point c) {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// Is d inside the circle through a, b, c, which are anticlockwise? Exact.
inline bool in_circle(Point a, Point b, Point c, Point d) {
  __extension__ using Wide = __int128;
  // The determinant of the rows (x, y, x^2 + y^2) of a, b and c, seen from d: squares times turns.
  const auto square = [d](Point p) {
    return std::int64_t{p.x - d.x} * (p.x - d.x) + std::int64_t{p.y - d.y} * (p.y - d.y);
  };
  const std::array<std::int64_t, 3> squares{square(a), square(b), square(c)};
  const std::array<std::int64_t, 3> turns{turn(d, b, c), turn(d, c, a), turn(d, a, b)};
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double term = static_cast<double>(squares[i]) * static_cast<double>(turns[i]);
    sum += term;
    size += std::abs(term);
  }
  // Factors are exact; each term is rounded once and each sum once, to within 2^-53.
  if (std::abs(sum) > 0x1p-50 * size) return sum > 0;
  Wide exact = 0;
  for (std::size_t i = 0; i < 3; ++i) exact += Wide{squares[i]} * turns[i];
  return exact > 0;
}

inline double squared_length(Point a, Point b) {
  return std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2);
}

/// Square of the circumradius of three points.
inline double circle_radius_squared(Point a, Point b, Point c) {
  return squared_length(a, b) * squared_length(b, c) * squared_length(c, a) /
         (4 * std::pow(static_cast<double>(turn(a, b, c)), 2));
}

/// The circumcentre of three points, rounded to integers. If it is far outside the range of
/// coordinates, a point on the way there that is also outside.
inline Point circle_centre(Point a, Point b, Point c) {
  const double b_squared = squared_length(a, b), c_squared = squared_length(a, c);
  const double scale = 0.5 / static_cast<double>(turn(a, b, c));
  const double x = a.x + scale * ((c.y - a.y) * b_squared - (b.y - a.y) * c_squared);
  const double y = a.y + scale * ((b.x - a.x) * c_squared - (c.x - a.x) * b_squared);
  const auto rounded = [](double value) {
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -0x1p23, 0x1.8p24)));
  };
  return {rounded(x), rounded(y)};
}

/// Triangles go anticlockwise. Across the edge opposite to corner i lies neighbour i, or `outside`.
struct Triangulation {
  std::vector<Point> points;
  std::vector<std::array<VertexId, 3>> corners_of;
  std::vector<std::array<TriangleId, 3>> neighbours_of;

  friend bool operator==(const Triangulation&, const Triangulation&) = default;
  Point corner(TriangleId t, std::size_t i) const { return points[corners_of[t][i % 3]]; }
};

/// Index of a value in an array that contains it.
inline std::size_t place_of(std::uint32_t value, const std::array<std::uint32_t, 3>& in) {
  return in[0] == value ? 0 : in[1] == value ? 1 : 2;
}

/// Sets the neighbours from the corners.
inline void find_neighbours(Triangulation& mesh) {
  struct Side {
    std::uint64_t ends;  // the lesser vertex in the upper half
    TriangleId triangle;
    std::uint32_t place;
    bool operator<(const Side& other) const { return ends < other.ends; }
  };
  std::vector<Side> sides;
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint64_t a = mesh.corners_of[t][(i + 1) % 3], b = mesh.corners_of[t][(i + 2) % 3];
      sides.push_back({std::min(a, b) << 32U | std::max(a, b), t, i});
    }
  std::sort(sides.begin(), sides.end());
  mesh.neighbours_of.assign(mesh.corners_of.size(), {outside, outside, outside});
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side &one = sides[i - 1], &two = sides[i];
    if (one.ends != two.ends) continue;
    mesh.neighbours_of[one.triangle][one.place] = two.triangle;
    mesh.neighbours_of[two.triangle][two.place] = one.triangle;
  }
}

/// The corners of all triangles, in an order that does not depend on how they were made.
inline std::vector<std::array<VertexId, 3>> sorted_corners(const Triangulation& mesh) {
  std::vector<std::array<VertexId, 3>> corners_of = mesh.corners_of;
  for (auto& corners : corners_of)
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::sort(corners_of.begin(), corners_of.end());
  return corners_of;
}

/// Twice the area covered by the triangles. -1 if one is not positive, if neighbours are
/// inconsistent or if a corner lies in the circumcircle of an adjacent triangle: 0 or more means
/// Delaunay.
inline std::int64_t delaunay_area(const Triangulation& mesh) {
  Triangulation again{mesh.points, mesh.corners_of, {}};
  find_neighbours(again);
  if (again.neighbours_of != mesh.neighbours_of) return -1;
  std::int64_t area = 0;
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t) {
    const std::int64_t own = turn(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    if (own <= 0) return -1;
    area += own;
    for (const TriangleId other : mesh.neighbours_of[t]) {
      if (other == outside) continue;
      const Point apex = mesh.corner(other, place_of(t, mesh.neighbours_of[other]));
      if (in_circle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), apex)) return -1;
    }
  }
  return area;
}

}  // namespace example
