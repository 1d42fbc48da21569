/// @file
/// Cavities: to put a point into a Delaunay triangulation, the triangles whose circles hold it go,
/// and triangles from the point to the sides of the hole they leave take their places (Bowyer and
/// Watson, 1981).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/cautious_operator.hpp"
#include "plane.hpp"

namespace example {

/// An edge of a cavity, which lies to its left, and the triangle to its right.
struct Side {
  VertexId begin, end;
  TriangleId beyond;
};

struct Cavity {
  Point point{};
  std::vector<TriangleId> triangles{};
  std::vector<Side> sides{};
};

/// Whether a point is on the wrong side of a boundary edge, or inside the circle on it.
inline bool is_in_the_way(Point begin, Point end, Point point) {
  const std::int64_t across = std::int64_t{begin.x - point.x} * (end.x - point.x) +
                              std::int64_t{begin.y - point.y} * (end.y - point.y);
  return across < 0 || turn(begin, end, point) <= 0;
}

enum class Dug {
  closed,      ///< the cavity is complete
  in_the_way,  ///< a boundary edge is in the way
  denied       ///< reach() said no
};

/// Fills in the triangles and sides of the cavity around its point, from triangle `start` on, which
/// has been reached; reaches for all others that it looks at. Stops at a boundary edge that is in
/// the way and tells it by `edge`, with the triangle on this side. If the point is the middle of a
/// boundary edge itself, `halved` is where that edge begins: it is no side then, and nothing is in
/// the way.
inline Dug dig(const Triangulation& mesh, Cavity& cavity, TriangleId start, auto& reach, Side& edge,
               VertexId halved = outside) {
  std::vector<TriangleId>& found = cavity.triangles;
  found.assign(1, start);
  cavity.sides.clear();
  for (std::size_t k = 0; k < found.size(); ++k) {
    const TriangleId t = found[k];
    for (std::size_t i = 0; i < 3; ++i) {
      const TriangleId other = mesh.neighbours_of[t][i];
      if (std::find(found.begin(), found.end(), other) != found.end()) continue;
      const VertexId begin = mesh.corners_of[t][(i + 1) % 3], end = mesh.corners_of[t][(i + 2) % 3];
      if (other == outside) {
        if (begin == halved) continue;
        edge = {begin, end, t};
        if (halved == outside && is_in_the_way(mesh.points[begin], mesh.points[end], cavity.point))
          return Dug::in_the_way;
      } else {
        if (!reach(other)) return Dug::denied;
        if (in_circle(mesh.corner(other, 0), mesh.corner(other, 1), mesh.corner(other, 2),
                      cavity.point)) {
          found.push_back(other);
          continue;
        }
      }
      cavity.sides.push_back({begin, end, other});
    }
  }
  return Dug::closed;
}

/// Triangles take other numbers, below `count`.
inline void renumber_triangles(Triangulation& mesh,
                               std::span<const ductile::runtime::Renumbered> moved,
                               std::size_t count) {
  for (const auto [from, to] : moved) {
    mesh.corners_of[to] = mesh.corners_of[from];
    mesh.neighbours_of[to] = mesh.neighbours_of[from];
    for (const TriangleId other : mesh.neighbours_of[to])
      if (other != outside)
        mesh.neighbours_of[other][place_of(from, mesh.neighbours_of[other])] = to;
  }
  mesh.corners_of.resize(count);
  mesh.neighbours_of.resize(count);
}

/// Vertices take other numbers, below `count`.
inline void renumber_vertices(Triangulation& mesh,
                              std::span<const ductile::runtime::Renumbered> moved,
                              std::size_t count) {
  if (!moved.empty()) {
    std::vector<VertexId> now_of(mesh.points.size() - count, outside);  // [vertex - count]
    for (const auto [from, to] : moved) {
      mesh.points[to] = mesh.points[from];
      now_of[from - count] = to;
    }
    for (auto& corners : mesh.corners_of)
      for (VertexId& vertex : corners)
        if (vertex >= count) vertex = now_of[vertex - count];
  }
  mesh.points.resize(count);
}

}  // namespace example
