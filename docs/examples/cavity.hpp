/// @file
/// Cavities: to insert a point into a Delaunay triangulation, the triangles whose circumcircles
/// contain it are removed, and triangles from the point to the sides of the cavity take their
/// places (Bowyer and Watson, 1981). The removed triangles form a tree, because there is no vertex
/// inside. A search around that tree visits each once, without a look-up among those found before,
/// and gives the sides of the cavity in order, anticlockwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/operator.hpp"
#include "plane.hpp"

namespace example {

/// An edge of a cavity, which lies to its left; `place` is the edge's number in triangle `beyond`.
struct CavitySide {
  VertexId begin, end;
  TriangleId beyond;
  std::uint32_t place;
};

enum class Dug {
  closed,   ///< the cavity is complete
  stopped,  ///< at a boundary edge
  denied    ///< reach() returned false
};

struct Cavity {
  Point point{};
  std::vector<TriangleId> triangles{};  ///< the removed triangles; after fill() the new ones
  std::vector<CavitySide> sides{};

  /// Finds the cavity of `point`, starting from triangle `start`, which has been reached; reaches
  /// for all other triangles that it reads. If `open` is less than 3, the point lies on that edge
  /// of `start`, a boundary edge, which is then no side. Calls stops(begin, end, triangle) at every
  /// other boundary edge, and stops when that returns true.
  Dug dig(const Triangulation& mesh, TriangleId start, std::uint32_t open, auto& reach,
          auto&& stops) {
    triangles.assign(1, start);
    sides.clear();
    ahead_.clear();
    const std::uint32_t first = open < 3 ? (open + 1) % 3 : 0;
    if (open == 3) ahead_.emplace_back(start, 2);
    ahead_.emplace_back(start, (first + 1) % 3);
    ahead_.emplace_back(start, first);
    while (!ahead_.empty()) {
      const auto [t, i] = ahead_.back();
      ahead_.pop_back();
      const TriangleId other = mesh.neighbours_of[t][i];
      const auto& corners = mesh.corners_of[t];
      const VertexId begin = corners[(i + 1) % 3], end = corners[(i + 2) % 3];
      if (other == outside) {
        if (stops(begin, end, t)) return Dug::stopped;
        sides.push_back({begin, end, outside, 0});
        continue;
      }
      if (!reach(other)) return Dug::denied;
      const auto j = static_cast<std::uint32_t>(place_of(t, mesh.neighbours_of[other]));
      if (in_circle(mesh.corner(other, 0), mesh.corner(other, 1), mesh.corner(other, 2), point)) {
        triangles.push_back(other);
        ahead_.emplace_back(other, (j + 2) % 3);
        ahead_.emplace_back(other, (j + 1) % 3);
      } else {
        sides.push_back({begin, end, other, j});
      }
    }
    return Dug::closed;
  }

  /// Replaces the cavity by triangles from its sides to a vertex; reuses its triangles first, then
  /// takes new ones.
  void fill(Triangulation& mesh, VertexId vertex, auto&& new_triangle) {
    mesh.points[vertex] = point;
    while (triangles.size() < sides.size()) triangles.push_back(new_triangle());
    const bool closed = sides.front().begin == sides.back().end;
    TriangleId before = closed ? triangles.back() : outside;
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const auto [begin, end, beyond, place] = sides[k];
      const bool is_last = k + 1 == sides.size();
      const TriangleId after = !is_last ? triangles[k + 1] : closed ? triangles[0] : outside;
      mesh.corners_of[triangles[k]] = {begin, end, vertex};
      mesh.neighbours_of[triangles[k]] = {after, before, beyond};
      if (beyond != outside) mesh.neighbours_of[beyond][place] = triangles[k];
      before = triangles[k];
    }
  }

 private:
  std::vector<std::pair<TriangleId, std::uint32_t>> ahead_;  // edges to look at
};

/// Is the point on the wrong side of a boundary edge, or inside the circle on that edge?
inline bool is_in_the_way(Point begin, Point end, Point point) {
  const std::int64_t across = std::int64_t{begin.x - point.x} * (end.x - point.x) +
                              std::int64_t{begin.y - point.y} * (end.y - point.y);
  return across < 0 || turn(begin, end, point) <= 0;
}

/// Walks from triangle to triangle to the one that contains the point, which lies inside the
/// triangulation. Returns false if a triangle is denied.
inline bool walk(const Triangulation& mesh, TriangleId& t, Point point, auto& reach) {
  for (TriangleId from = outside;;) {
    if (!reach(t)) return false;
    std::size_t i = 0;
    for (; i < 3; ++i) {
      const TriangleId other = mesh.neighbours_of[t][i];
      if (other != from && turn(mesh.corner(t, i + 1), mesh.corner(t, i + 2), point) < 0) break;
    }
    if (i == 3) return true;
    from = std::exchange(t, mesh.neighbours_of[t][i]);
  }
}

/// Moves triangles to other numbers, below `count`.
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

/// Moves vertices to other numbers, below `count`.
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
