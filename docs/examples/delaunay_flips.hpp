/// @file
/// The Delaunay triangulation of points by edge flips: from any triangulation, an edge is replaced
/// by the other diagonal of its two triangles if the circle through one holds the far corner of the
/// other (Lawson, 1977). Many edges flip at once; a flip reserves its two triangles and the two
/// whose neighbours change.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "plane.hpp"

namespace example {

namespace runtime = ductile::runtime;

class FlipEdges {
 public:
  // ---- What it works on: 3 t + i is the edge of triangle t opposite to its corner i ----
  using Item = std::uint32_t;
  struct Plan {
    TriangleId one, two;    // beside the edge
    std::size_t far, near;  // the corners opposite to it: their places in one and in two
  };
  struct Update {
    TriangleId before, now;
  };

  explicit FlipEdges(Triangulation& mesh) : mesh_(mesh) {}

  // ---- Plan: flip if the far corner is inside the circle. Reads only. ----
  std::optional<Plan> plan(Item edge) const {
    const TriangleId one = edge / 3, two = mesh_.neighbours_of[one][edge % 3];
    if (two == outside) return {};
    const std::size_t near = place_of(one, mesh_.neighbours_of[two]);
    if (!in_circle(mesh_.corner(one, 0), mesh_.corner(one, 1), mesh_.corner(one, 2),
                   mesh_.corner(two, near)))
      return {};
    return Plan{one, two, edge % 3, near};
  }
  // ---- Conflict rule: both triangles change, and what two of their neighbours know of them ----
  void footprint(Item edge, auto&& visit) const {
    const std::optional<Plan> flip = plan(edge);
    if (!flip) return;
    visit(flip->one);
    visit(flip->two);
    for (const TriangleId other : {left_of_two(*flip), left_of_one(*flip)})
      if (other != outside) visit(other);
  }
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  // ---- Apply: turn the diagonal; tell two neighbours; look at the four edges around again ----
  void apply(const Plan& flip, auto& commit) {
    auto& corners_one = mesh_.corners_of[flip.one];
    auto& corners_two = mesh_.corners_of[flip.two];
    auto& beside_one = mesh_.neighbours_of[flip.one];
    auto& beside_two = mesh_.neighbours_of[flip.two];
    const std::size_t f = flip.far, n = flip.near;
    if (left_of_two(flip) != outside) commit.defer(left_of_two(flip), {flip.two, flip.one});
    if (left_of_one(flip) != outside) commit.defer(left_of_one(flip), {flip.one, flip.two});
    corners_one[(f + 2) % 3] = corners_two[n];
    corners_two[(n + 2) % 3] = corners_one[f];
    beside_one[f] = beside_two[(n + 1) % 3];
    beside_two[n] = beside_one[(f + 1) % 3];
    beside_one[(f + 1) % 3] = flip.two;
    beside_two[(n + 1) % 3] = flip.one;
    for (const std::size_t place : {f, (f + 2) % 3})
      commit.wake(3 * flip.one + static_cast<Item>(place));
    for (const std::size_t place : {n, (n + 2) % 3})
      commit.wake(3 * flip.two + static_cast<Item>(place));
  }
  // ---- Commit: a triangle has another neighbour ----
  void commit(TriangleId owner, const Update& update) {
    auto& neighbours = mesh_.neighbours_of[owner];
    neighbours[place_of(update.before, neighbours)] = update.now;
  }

 private:
  /// The neighbours that pass from triangle two to one, and from one to two.
  TriangleId left_of_two(const Plan& flip) const {
    return mesh_.neighbours_of[flip.two][(flip.near + 1) % 3];
  }
  TriangleId left_of_one(const Plan& flip) const {
    return mesh_.neighbours_of[flip.one][(flip.far + 1) % 3];
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
