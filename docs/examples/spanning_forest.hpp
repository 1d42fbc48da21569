/// @file
/// A spanning forest: edges that join the vertices of each component of a graph into a tree. Edges
/// are taken in order, and an edge is left out if earlier ones join its ends already: the result is
/// the forest of a plain loop, and a minimum spanning forest if edges are sorted by weight
/// (Kruskal, 1956).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

class SpanningForest {
 public:
  // ---- Items: the numbers of edges ----
  using Item = std::uint32_t;
  struct Plan {
    Vertex root, other_root;
  };

  SpanningForest(const runtime::Executor& executor, std::size_t vertex_count,
                 const std::vector<Edge>& edges)
      : edges_(edges), trees_(executor, vertex_count) {}

  // ---- Resources: vertices; an edge needs the roots of its two trees ----
  std::size_t resource_count() const { return trees_.size(); }
  // ---- Plan: join two trees, which each have their lowest vertex as root ----
  bool plan(Item edge, Plan& plan, auto& reach) const {
    const auto [a, b] = edges_[edge];
    if (trees_.are_together(a, b)) return false;
    plan.root = trees_.lowest(a);
    plan.other_root = trees_.lowest(b);
    return reach_root(plan.root, reach) && reach_root(plan.other_root, reach) &&
           plan.root != plan.other_root;
  }
  // ---- Apply ----
  void apply(Item, Plan& plan, auto& /*commit*/) { trees_.unite_roots(plan.root, plan.other_root); }

 private:
  /// Reaches for the root of a vertex's tree. Because others write, a root may have got a parent by
  /// the time it is reached; once reached, it stays a root.
  bool reach_root(Vertex& vertex, auto& reach) const {
    while (reach(vertex)) {
      const Vertex root = trees_.lowest(vertex);
      if (root == vertex) return true;
      vertex = root;
    }
    return false;
  }

  const std::vector<Edge>& edges_;
  // Any thread may ask for a root, which also shortens the path to it.
  mutable runtime::DisjointSets trees_;
};

/// The numbers of the forest's edges, ascending; fills in a report if there is one.
inline std::vector<std::uint32_t> spanning_forest_in_parallel(
    const runtime::Executor& executor, std::size_t vertex_count, const std::vector<Edge>& edges,
    runtime::RoundsReport* report = nullptr) {
  SpanningForest forest(executor, vertex_count, edges);
  return runtime::applied_in_order(executor, forest, runtime::AllNumbers(edges.size()), report);
}

}  // namespace example
