/// @file
/// Delaunay refinement (Ruppert, J. Algorithms 18, 1995): the centre of a bad triangle's circle
/// becomes a vertex, and the triangles whose circles hold it, the cavity, are replaced by triangles
/// around it; a boundary edge in its way is halved instead. An insertion reserves its cavity and
/// the triangles around that.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cavity.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "plane.hpp"

namespace example {

namespace runtime = ductile::runtime;

class RefineTriangles {
 public:
  // ---- What it works on: a triangle, for as long as it has the last corner that it has now ----
  struct Item {
    TriangleId triangle;
    VertexId last;
    friend auto operator<=>(const Item&, const Item&) = default;
  };
  struct Plan {
    Item item;
    Cavity cavity;
    std::vector<TriangleId> also_read;
  };
  struct Update {
    VertexId begin;  // of the edge, seen from the owner
    TriangleId now;
  };

  RefineTriangles(Triangulation& mesh, double size) : mesh_(mesh), size_(size) {}

  /// Too large, or with an angle below 20.7 degrees: the radius is over sqrt(2) shortest edges.
  bool is_bad(TriangleId t) const {
    const Point a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
    const double shortest =
        std::min({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
    return circle_radius_squared(a, b, c) > std::min(2 * shortest, size_ * size_);
  }

  // ---- Plan: the cavity of the circle's centre, or of the middle of an edge. Reads only. ----
  std::optional<Plan> plan(const Item& item) const {
    const TriangleId t = item.triangle;
    if (mesh_.corners_of[t][2] != item.last || !is_bad(t)) return {};
    Cavity cavity{circle_centre(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2))};
    const std::optional<Side> in_the_way = dig(mesh_, cavity, t);
    if (!in_the_way) return Plan{item, std::move(cavity), {}};
    const Point a = mesh_.points[in_the_way->begin], b = mesh_.points[in_the_way->end];
    Plan halving{item, {{(a.x + b.x) / 2, (a.y + b.y) / 2}}, std::move(cavity.triangles)};
    for (const Side& side : cavity.sides) halving.also_read.push_back(side.beyond);
    dig(mesh_, halving.cavity, in_the_way->beyond, in_the_way->begin);
    return halving;
  }
  // ---- Conflict rule: the cavity goes, the triangles around it get new neighbours ----
  void footprint(const Item& item, auto&& visit) const {
    const std::optional<Plan> insertion = plan(item);
    if (!insertion) return;
    for (const TriangleId gone : insertion->cavity.triangles) visit(gone);
    for (const Side& side : insertion->cavity.sides)
      if (side.beyond != outside) visit(side.beyond);
    for (const TriangleId read : insertion->also_read)
      if (read != outside) visit(read);
  }
  std::size_t resource_count() const { return mesh_.corners_of.size(); }
  // ---- Growth: a vertex, and one or two triangles more than there were ----
  std::array<std::uint32_t, 2> demand(const Plan& insertion) const {
    const Cavity& cavity = insertion.cavity;
    return {1, static_cast<std::uint32_t>(cavity.sides.size() - cavity.triangles.size())};
  }
  std::array<std::uint32_t, 2> grow(const std::array<std::uint32_t, 2>& more) {
    const std::array<std::size_t, 2> first{mesh_.points.size(), mesh_.corners_of.size()};
    mesh_.points.resize(first[0] + more[0]);
    mesh_.corners_of.resize(first[1] + more[1]);
    mesh_.neighbours_of.resize(first[1] + more[1]);
    return {static_cast<std::uint32_t>(first[0]), static_cast<std::uint32_t>(first[1])};
  }
  // ---- Apply: a triangle on each side of the cavity; wake those that are bad ----
  void apply(const Plan& insertion, auto& commit) {
    const VertexId vertex = commit.fresh(0);
    mesh_.points[vertex] = insertion.cavity.point;
    const std::vector<Side>& sides = insertion.cavity.sides;
    std::vector<TriangleId> triangles = insertion.cavity.triangles;
    while (triangles.size() < sides.size()) triangles.push_back(commit.fresh(1));
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      mesh_.corners_of[triangles[i]] = {side.begin, side.end, vertex};
      mesh_.neighbours_of[triangles[i]] = {outside, outside, side.beyond};
      if (side.beyond != outside) commit.defer(side.beyond, {side.end, triangles[i]});
      for (std::size_t j = 0; j < sides.size(); ++j) {
        if (sides[j].begin == side.end) mesh_.neighbours_of[triangles[i]][0] = triangles[j];
        if (sides[j].end == side.begin) mesh_.neighbours_of[triangles[i]][1] = triangles[j];
      }
      if (is_bad(triangles[i])) commit.wake({triangles[i], vertex});
    }
    commit.wake(insertion.item);
  }
  // ---- Commit: a triangle has another neighbour ----
  void commit(TriangleId owner, const Update& update) {
    const std::size_t begin = place_of(update.begin, mesh_.corners_of[owner]);
    mesh_.neighbours_of[owner][(begin + 2) % 3] = update.now;
  }

 private:
  Triangulation& mesh_;
  double size_;  // no triangle's circle has a greater radius
};

/// All triangles, to begin with.
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
  const runtime::RoundsReport rounds =
      runtime::run_rounds(executor, refine, all_triangles(mesh), {.least_won = 0.5});
  if (report) *report = rounds;
}

}  // namespace example
