/// @file
/// The Delaunay triangulation of points by edge flips: in any triangulation, an edge is replaced by
/// the other diagonal of its two triangles if the circumcircle of one contains the far corner of
/// the other (Lawson, 1977). A flip changes its two triangles, and two that get other neighbours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "plane.hpp"

namespace example {

namespace runtime = ductile::runtime;

class FlipEdges {
 public:
  // ---- Items: 3 t + i is the edge of triangle t opposite to its corner i ----
  using Item = std::uint32_t;
  struct Plan {
    TriangleId one, two;                  // beside the edge
    std::size_t far, near;                // the corners opposite to it: their places in one and two
    TriangleId left_of_one, left_of_two;  // neighbours that pass to the other triangle, or outside
  };

  explicit FlipEdges(Triangulation& mesh) : mesh_(mesh) {}

  // ---- Resources: triangles, close together if they are reached together ----
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  std::array<double, 2> place_of(TriangleId t) const {
    const Point point = mesh_.corner(t, 0);
    return {static_cast<double>(point.x), static_cast<double>(point.y)};
  }

  // ---- Plan: flip if the far corner is inside the circle. Reads only what it has reached ----
  bool plan(Item edge, Plan& flip, auto& reach) const {
    flip.one = edge / 3;
    flip.far = edge % 3;
    if (!reach(flip.one)) return false;
    flip.two = mesh_.neighbours_of[flip.one][flip.far];
    if (flip.two == outside || !reach(flip.two)) return false;
    flip.near = example::place_of(flip.one, mesh_.neighbours_of[flip.two]);
    if (!in_circle(mesh_.corner(flip.one, 0), mesh_.corner(flip.one, 1), mesh_.corner(flip.one, 2),
                   mesh_.corner(flip.two, flip.near)))
      return false;
    flip.left_of_two = mesh_.neighbours_of[flip.two][(flip.near + 1) % 3];
    flip.left_of_one = mesh_.neighbours_of[flip.one][(flip.far + 1) % 3];
    return (flip.left_of_two == outside || reach(flip.left_of_two)) &&
           (flip.left_of_one == outside || reach(flip.left_of_one));
  }
  // ---- Apply: flip the edge, update two neighbours, and wake the four edges around ----
  void apply(Item, Plan& flip, auto& commit) {
    auto& corners_one = mesh_.corners_of[flip.one];
    auto& corners_two = mesh_.corners_of[flip.two];
    auto& beside_one = mesh_.neighbours_of[flip.one];
    auto& beside_two = mesh_.neighbours_of[flip.two];
    const std::size_t f = flip.far, n = flip.near;
    set_neighbour(flip.left_of_two, flip.two, flip.one);
    set_neighbour(flip.left_of_one, flip.one, flip.two);
    corners_one[(f + 2) % 3] = corners_two[n];
    corners_two[(n + 2) % 3] = corners_one[f];
    beside_one[f] = flip.left_of_two;
    beside_two[n] = flip.left_of_one;
    beside_one[(f + 1) % 3] = flip.two;
    beside_two[(n + 1) % 3] = flip.one;
    for (const std::size_t place : {f, (f + 2) % 3})
      commit.wake(3 * flip.one + static_cast<Item>(place));
    for (const std::size_t place : {n, (n + 2) % 3})
      commit.wake(3 * flip.two + static_cast<Item>(place));
  }

 private:
  void set_neighbour(TriangleId t, TriangleId before, TriangleId now) {
    if (t == outside) return;
    auto& neighbours = mesh_.neighbours_of[t];
    neighbours[example::place_of(before, neighbours)] = now;
  }

  Triangulation& mesh_;
};

/// Every edge between two triangles once.
inline std::vector<FlipEdges::Item> inner_edges(const Triangulation& mesh) {
  std::vector<FlipEdges::Item> edges;
  for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i)
      if (mesh.neighbours_of[t][i] < t) edges.push_back(3 * t + i);
  return edges;
}

/// Flips edges of a triangulation until it is Delaunay; fills in a report if there is one.
inline void delaunay_flips_in_parallel(const runtime::Executor& executor, Triangulation& mesh,
                                       runtime::RoundsReport* report = nullptr) {
  FlipEdges flip(mesh);
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, flip, inner_edges(mesh));
  if (report) *report = rounds;
}

}  // namespace example
