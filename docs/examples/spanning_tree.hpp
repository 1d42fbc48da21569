/// @file
/// The minimum spanning tree of a graph with random weights by contraction, Boruvka's way: every
/// vertex looks for the lightest edge that leaves it, and the two ends become one. Each vertex
/// keeps the edges that leave it in a heap, and two heaps melt into one. A contraction reserves its
/// two ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"
#include "skew_heaps.hpp"

namespace example {

namespace runtime = ductile::runtime;

struct Arc {
  Weight weight;
  Vertex target;  // it may have been contracted since
  bool operator<(const Arc& other) const { return weight < other.weight; }
};

class Contraction {
 public:
  // ---- What it works on: vertices, those contracted into others included ----
  using Item = Vertex;
  struct Plan {
    Vertex item, gone, kept;
  };
  struct Update {
    Vertex parent;
  };

  Contraction(const runtime::Executor& executor, runtime::CsrGraph<> graph)
      : tree_edge_of(graph.vertex_count()),
        parent_of_(graph.vertex_count()),
        size_of_(graph.vertex_count(), 1),
        heap_of_(graph.vertex_count(), Heaps::none),
        heaps_(graph.neighbour.size()) {
    runtime::parallel_for(executor, graph.vertex_count(), [&](std::size_t i) {
      const auto from = static_cast<Vertex>(i);
      parent_of_[from] = from;
      for (std::uint32_t arc = graph.offset[from]; arc < graph.offset[from + 1]; ++arc) {
        heaps_.least(arc) = {weight_of(from, graph.neighbour[arc]), graph.neighbour[arc]};
        heap_of_[from] = heaps_.melt(heap_of_[from], arc);
      }
    });
  }

  // ---- Plan: contract the lightest edge, unless the vertex is gone or has none. Reads only. ----
  std::optional<Plan> plan(Vertex vertex) const {
    if (parent_of_[vertex] != vertex || heap_of_[vertex] == Heaps::none) return {};
    const Vertex other = root(heaps_.least(heap_of_[vertex]).target);
    if (size_of_[vertex] > size_of_[other]) return Plan{vertex, other, vertex};
    return Plan{vertex, vertex, other};
  }
  // ---- Conflict rule: both ends change ----
  void footprint(Vertex vertex, auto&& visit) const {
    const std::optional<Plan> contraction = plan(vertex);
    if (!contraction) return;
    visit(contraction->gone);
    visit(contraction->kept);
  }
  std::size_t resource_count() const { return parent_of_.size(); }
  // ---- Apply: one heap out of two. Others look for `gone`, so telling them has to wait. ----
  void apply(const Plan& plan, auto& commit) {
    tree_edge_of[plan.gone] = heaps_.least(heap_of_[plan.item]).weight;
    size_of_[plan.kept] += size_of_[plan.gone];
    auto& heap = heap_of_[plan.kept];
    heap = heaps_.melt(heap, heap_of_[plan.gone]);
    if (size_of_[plan.kept] == size_of_.size()) heap = Heaps::none;  // that was the last edge
    while (heap != Heaps::none && leads_inside(heaps_.least(heap), plan))
      heap = heaps_.without_least(heap);
    commit.defer(plan.gone, {plan.kept});
    if (plan.kept == plan.item) commit.wake(plan.kept);  // else it still waits for its own turn
  }
  // ---- Commit: from now on the vertex is its parent ----
  void commit(std::uint32_t gone, const Update& update) { parent_of_[gone] = update.parent; }

  std::vector<Weight> tree_edge_of;  // [vertex], the edge by which it was contracted, or 0

 private:
  using Heaps = SkewHeaps<Arc>;

  /// What a vertex has become. The larger takes in the smaller, so the way there is short.
  Vertex root(Vertex vertex) const {
    while (parent_of_[vertex] != vertex) vertex = parent_of_[vertex];
    return vertex;
  }
  bool leads_inside(Arc& arc, const Plan& plan) const {
    arc.target = root(arc.target);  // shorter next time
    return arc.target == plan.gone || arc.target == plan.kept;
  }

  std::vector<Vertex> parent_of_;       // [vertex], itself unless contracted
  std::vector<std::uint32_t> size_of_;  // [vertex], how many it stands for
  std::vector<Heaps::Heap> heap_of_;    // [vertex], the arcs that leave it
  Heaps heaps_;                         // of arcs, numbered as the graph's neighbours
};

/// [vertex], the weight of the edge by which it was contracted, or 0: weights of the tree's edges.
/// Fills in a report if there is one.
inline std::vector<Weight> spanning_tree_in_parallel(const runtime::Executor& executor,
                                                     runtime::CsrGraph<> graph,
                                                     runtime::RoundsReport* report = nullptr) {
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  Contraction contraction(executor, graph);
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, contraction, vertices);
  if (report) *report = rounds;
  return contraction.tree_edge_of;
}

}  // namespace example
