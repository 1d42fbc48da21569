/// @file
/// TriangleEdges: the edges of a list of triangles, and which triangles meet there.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "geometry/facet_sides.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The next corner of a triangle.
constexpr std::size_t next_corner(std::size_t corner) { return (corner + 1) % 3; }

/// An edge of a triangle. Corners turn from `from` to the other end.
struct TriangleEdge {
  SideKey key;
  ElementId triangle;
  VertexId from;
  friend auto operator<=>(const TriangleEdge&, const TriangleEdge&) = default;
};

/// Edges that are passed by triangles, of two by both in the same direction.
class TriangleEdges {
 public:
  TriangleEdges(const runtime::Executor& executor, const std::vector<Corners<2>>& triangles)
      : edges_(runtime::make_unset_vector<TriangleEdge>(executor, 3 * triangles.size())) {
    runtime::parallel_for(executor, triangles.size(), [&](std::size_t e) {
      for (std::size_t i = 0; i < 3; ++i) {
        const VertexId a = triangles[e][i], b = triangles[e][next_corner(i)];
        edges_[3 * e + i] = {edge_key(a, b), static_cast<ElementId>(e), a};
      }
    });
    runtime::parallel_sort(executor, std::span(edges_));
  }

  /// Calls visit(run) with the passes of each edge.
  void each(auto&& visit) const {
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      while (end < edges_.size() && edges_[end].key == edges_[begin].key) ++end;
      visit(std::span(edges_).subspan(begin, end - begin));
    }
  }

  /// Edges of two triangles that are turned in opposite ways.
  std::vector<SideKey> seams() const {
    std::vector<SideKey> seams;
    each([&](std::span<const TriangleEdge> run) {
      if (run.size() == 2 && run[0].from == run[1].from) seams.push_back(run[0].key);
    });
    return seams;
  }

  /// The other triangle at an edge of two, and whether it is turned in the opposite way.
  std::pair<ElementId, bool> across(SideKey key, ElementId triangle) const {
    const auto at = std::lower_bound(edges_.begin(), edges_.end(), TriangleEdge{key, 0, 0});
    if (edges_.end() - at < 2 || at[1].key != key || (edges_.end() - at > 2 && at[2].key == key))
      return {none, false};
    return {at[0].triangle == triangle ? at[1].triangle : at[0].triangle, at[0].from == at[1].from};
  }

 private:
  runtime::UnsetVector<TriangleEdge> edges_;  // sorted
};

}  // namespace ductile::meshadapt
