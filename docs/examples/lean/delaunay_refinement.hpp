/// @file
/// Ruppert's refinement, serially: a stack of bad triangles, and a cavity whose memory is reused.
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "../cavity.hpp"
#include "triangles.hpp"

namespace lean {

/// Inserts points into a Delaunay triangulation until no triangle's circumradius exceeds `size`, or
/// sqrt(2) times the triangle's shortest edge.
class DelaunayRefinement {
 public:
  DelaunayRefinement(Triangulation& mesh, double size) : mesh_(mesh), size_squared_(size * size) {}

  void run() {
    for (TriangleId t = 0; t < mesh_.corners_of.size(); ++t) wake(t);
    while (!waiting_.empty()) {
      const auto [triangle, last] = waiting_.back();
      waiting_.pop_back();
      if (mesh_.corners_of[triangle][2] != last || !is_bad(triangle)) continue;
      insert(triangle);
      for (const TriangleId t : cavity_.triangles)
        if (is_bad(t)) wake(t);
      // If an edge in the way was halved, the triangle may still exist.
      if (mesh_.corners_of[triangle][2] == last) waiting_.push_back({triangle, last});
    }
  }

  bool is_bad(TriangleId t) const {
    const Point a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
    const double shortest =
        std::min({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
    return circle_radius_squared(a, b, c) > std::min(2 * shortest, size_squared_);
  }

 private:
  /// A triangle, valid as long as its last corner stays the same.
  struct Bad {
    TriangleId triangle;
    VertexId last;
  };

  void wake(TriangleId t) { waiting_.push_back({t, mesh_.corners_of[t][2]}); }

  /// The circumcentre of a triangle, or the midpoint of a boundary edge in its way.
  void insert(TriangleId t) {
    cavity_.point = circle_centre(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
    VertexId begin = 0, end = 0;
    TriangleId inside = t;
    const auto is_stopped_by = [&](VertexId from, VertexId to, TriangleId beside) {
      std::tie(begin, end, inside) = {from, to, beside};
      return is_in_the_way(mesh_.points[from], mesh_.points[to], cavity_.point);
    };
    if (cavity_.dig(mesh_, t, 3, anywhere, is_stopped_by) == example::Dug::stopped) {
      const Point a = mesh_.points[begin], b = mesh_.points[end];
      cavity_.point = {(a.x + b.x) / 2, (a.y + b.y) / 2};
      const auto edge = static_cast<std::uint32_t>(place_of(begin, mesh_.corners_of[inside]) + 2);
      cavity_.dig(mesh_, inside, edge % 3, anywhere, [](auto...) { return false; });
    }
    const auto vertex = static_cast<VertexId>(mesh_.points.size());
    mesh_.points.emplace_back();
    cavity_.fill(mesh_, vertex, [&] { return add_triangle(mesh_); });
  }

  Triangulation& mesh_;
  double size_squared_;
  example::Cavity cavity_;
  std::vector<Bad> waiting_;
};

inline void delaunay_refinement(Triangulation& mesh, double size) {
  DelaunayRefinement(mesh, size).run();
}

}  // namespace lean
