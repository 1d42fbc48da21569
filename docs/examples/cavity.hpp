/// @file
/// Cavities: to put a point into a Delaunay triangulation, the triangles whose circles hold it go,
/// and triangles from the point to the sides of the hole they leave take their places (Bowyer and
/// Watson, 1981).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "plane.hpp"

namespace example {

/// An edge of a cavity, which lies to its left, and the triangle to its right.
struct Side {
  VertexId begin, end;
  TriangleId beyond;
};

struct Cavity {
  Point point;
  std::vector<TriangleId> triangles{};
  std::vector<Side> sides{};
};

/// Whether a point is on the wrong side of a boundary edge, or inside the circle on it.
inline bool is_in_the_way(Point begin, Point end, Point point) {
  const std::int64_t across = std::int64_t{begin.x - point.x} * (end.x - point.x) +
                              std::int64_t{begin.y - point.y} * (end.y - point.y);
  return across < 0 || turn(begin, end, point) <= 0;
}

/// Fills in the triangles and sides of the cavity around its point, from triangle `start` on.
/// Stops at a boundary edge that is in the way and returns it, with the triangle on this side.
/// If the point is the middle of a boundary edge itself, `halved` is where that edge begins: it is
/// no side then, and nothing is in the way.
inline std::optional<Side> dig(const Triangulation& mesh, Cavity& cavity, TriangleId start,
                               VertexId halved = outside) {
  std::vector<TriangleId>& found = cavity.triangles;
  found.push_back(start);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const TriangleId t = found[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const TriangleId other = mesh.neighbours_of[t][i];
      if (std::find(found.begin(), found.end(), other) != found.end()) continue;
      const VertexId begin = mesh.corners_of[t][(i + 1) % 3], end = mesh.corners_of[t][(i + 2) % 3];
      if (other == outside) {
        if (begin == halved) continue;
        if (halved == outside && is_in_the_way(mesh.points[begin], mesh.points[end], cavity.point))
          return Side{begin, end, t};
      } else if (in_circle(mesh.corner(other, 0), mesh.corner(other, 1), mesh.corner(other, 2),
                           cavity.point)) {
        found.push_back(other);
        continue;
      }
      cavity.sides.push_back({begin, end, other});
    }
  }
  return {};
}

}  // namespace example
