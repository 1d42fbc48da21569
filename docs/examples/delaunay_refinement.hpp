/// @file
/// Delaunay refinement (Ruppert, J. Algorithms 18, 1995): the circumcentre of a bad triangle
/// becomes a vertex, and the triangles whose circumcircles contain it, the cavity, are replaced by
/// triangles around it. If a boundary edge is in the way, that is halved instead.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "cavity.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "plane.hpp"

namespace example {

namespace runtime = ductile::runtime;

class RefineTriangles {
 public:
  // ---- Items: a triangle, valid as long as its last corner stays the same ----
  struct Item {
    TriangleId triangle;
    VertexId last;
  };
  using Plan = Cavity;

  /// Refines until no circumradius exceeds `size`.
  RefineTriangles(Triangulation& mesh, double size) : mesh_(mesh), size_(size) {}

  /// Is the triangle too large, or has it an angle below 20.7 degrees (a circumradius above sqrt(2)
  /// shortest edges)?
  bool is_bad(TriangleId t) const {
    const Point a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
    const double shortest =
        std::min({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
    return circle_radius_squared(a, b, c) > std::min(2 * shortest, size_ * size_);
  }

  // ---- Resources: triangles, close together if they are reached together ----
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  std::array<double, 2> place_of(TriangleId t) const {
    const Point point = mesh_.corner(t, 2);
    return {static_cast<double>(point.x), static_cast<double>(point.y)};
  }

  // ---- Plan: the cavity of the circumcentre, or of the midpoint of an edge in its way ----
  bool plan(const Item& item, Cavity& cavity, auto& reach) const {
    const TriangleId t = item.triangle;
    if (!reach(t) || mesh_.corners_of[t][2] != item.last || !is_bad(t)) return false;
    cavity.point = circle_centre(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
    VertexId begin = 0, end = 0;
    TriangleId inside = t;
    Dug dug = cavity.dig(mesh_, t, 3, reach, [&](VertexId from, VertexId to, TriangleId beside) {
      std::tie(begin, end, inside) = {from, to, beside};
      return is_in_the_way(mesh_.points[from], mesh_.points[to], cavity.point);
    });
    if (dug == Dug::stopped) {
      const Point a = mesh_.points[begin], b = mesh_.points[end];
      cavity.point = {(a.x + b.x) / 2, (a.y + b.y) / 2};
      const std::size_t edge = (example::place_of(begin, mesh_.corners_of[inside]) + 2) % 3;
      dug = cavity.dig(mesh_, inside, static_cast<std::uint32_t>(edge), reach,
                       [](auto...) { return false; });
    }
    return dug == Dug::closed;
  }
  // ---- Apply: a triangle on each side of the cavity; wake the bad ones ----
  void apply(const Item& item, Cavity& cavity, auto& commit) {
    const VertexId vertex = commit.fresh(1);
    cavity.fill(mesh_, vertex, [&] { return commit.fresh(0); });
    for (const TriangleId t : cavity.triangles)
      if (is_bad(t)) commit.wake({t, vertex});
    // If an edge in the way was halved, the triangle may still exist.
    if (mesh_.corners_of[item.triangle][2] == item.last) commit.wake(item);
  }

  // ---- Made things: triangles, which are the resources, and vertices ----
  std::array<std::size_t, 2> counts() const {
    return {mesh_.corners_of.size(), mesh_.points.size()};
  }
  std::array<std::size_t, 2> demand(const Cavity& cavity) const {
    return {cavity.sides.size() - cavity.triangles.size(), 1};
  }
  void grow(const std::array<std::size_t, 2>& room) {
    mesh_.corners_of.resize(room[0]);
    mesh_.neighbours_of.resize(room[0]);
    mesh_.points.resize(room[1]);
  }
  void renumber(std::size_t kind, std::span<const runtime::Renumbered> moved, std::size_t count) {
    if (kind == 0) {
      renumber_triangles(mesh_, moved, count);
    } else {
      renumber_vertices(mesh_, moved, count);
    }
  }

 private:
  Triangulation& mesh_;
  double size_;
};

/// The work to start with: every triangle as an item.
inline std::vector<RefineTriangles::Item> all_triangles(const Triangulation& mesh) {
  std::vector<RefineTriangles::Item> triangles;
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    triangles.push_back({t, mesh.corners_of[t][2]});
  return triangles;
}

/// Refines a Delaunay triangulation until no triangle is bad, see RefineTriangles::is_bad(). Fills
/// in a report if there is one.
inline void delaunay_refinement_in_parallel(const runtime::Executor& executor, Triangulation& mesh,
                                            double size, runtime::RoundsReport* report = nullptr) {
  RefineTriangles refine(mesh, size);
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, refine, all_triangles(mesh));
  if (report) *report = rounds;
}

}  // namespace example
