/// @file
/// Cavities for serial codes: the triangles whose circles hold a point are a tree, because there is
/// no vertex inside. A search that goes around that tree finds each once, without looking for it
/// among those found before, and the sides of the cavity in their order, anticlockwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../plane.hpp"

namespace lean {

using example::outside, example::place_of, example::Point, example::TriangleId,
    example::Triangulation, example::VertexId;

/// An edge of a cavity, which lies to its left; `place` is that of the edge in triangle `beyond`.
struct CavitySide {
  VertexId begin, end;
  TriangleId beyond;
  std::uint32_t place;
};

struct Cavity {
  std::vector<TriangleId> triangles{};  ///< those that go; after fill() those that came
  std::vector<CavitySide> sides{};

  /// Finds the cavity of a point from triangle `start` on. If `open` is less than 3, the point is
  /// on that edge of `start`, a boundary edge, which is no side then. Calls stops(begin, end,
  /// triangle) at every other boundary edge; returns false as soon as that is true.
  template <class Stops>
  bool dig(const Triangulation& mesh, Point point, TriangleId start, std::uint32_t open,
           Stops&& stops) {
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
        if (stops(begin, end, t)) return false;
        sides.push_back({begin, end, outside, 0});
        continue;
      }
      const auto j = static_cast<std::uint32_t>(place_of(t, mesh.neighbours_of[other]));
      if (in_circle(mesh.corner(other, 0), mesh.corner(other, 1), mesh.corner(other, 2), point)) {
        triangles.push_back(other);
        ahead_.emplace_back(other, (j + 2) % 3);
        ahead_.emplace_back(other, (j + 1) % 3);
      } else {
        sides.push_back({begin, end, other, j});
      }
    }
    return true;
  }

  /// Puts triangles from the sides to a vertex in place of the cavity, first those that were there.
  void fill(Triangulation& mesh, VertexId vertex) {
    while (triangles.size() < sides.size()) {
      triangles.push_back(static_cast<TriangleId>(mesh.corners_of.size()));
      mesh.corners_of.emplace_back();
      mesh.neighbours_of.emplace_back();
    }
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

}  // namespace lean
