/// @file
/// A minimum-degree ordering of a graph, for sparse factors: the vertex with the fewest neighbours
/// is eliminated, which joins these to each other, then the next. Levels are degrees, each divided
/// into 64 ranges of vertex numbers, which leaves less fill for plane graphs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "ductile/runtime/sort.hpp"
#include "graphs.hpp"
#include "quotient_graph.hpp"

namespace example {

namespace runtime = ductile::runtime;

struct Ordering {
  std::vector<Vertex> order;  ///< all vertices
  std::uint64_t fill = 0;     ///< number of entries of the factor L, including its diagonal
  friend bool operator==(const Ordering&, const Ordering&) = default;
};

class MinimumDegree {
 public:
  struct Item {
    Vertex vertex;
    std::uint32_t degree, version;
  };
  struct Plan {
    std::vector<Vertex> clique;  // the neighbours of the vertex
    QuotientGraph::Scratch scratch;
    friend bool operator==(const Plan& a, const Plan& b) { return a.clique == b.clique; }
  };

  explicit MinimumDegree(runtime::CsrGraph<> graph)
      : graph_(graph),
        version_of_(graph.vertex_count()),
        step_of_(graph.vertex_count()),
        is_pivot_(graph.vertex_count()) {}

  /// The initial work: all vertices.
  std::vector<Item> all_items() const {
    std::vector<Item> items(graph_.size());
    for (Vertex v = 0; v < items.size(); ++v) items[v] = {v, graph_.degree(v), 0};
    return items;
  }

  // ---- Resources: vertices, and the elements that they become ----
  std::size_t resource_count() const { return graph_.size(); }
  std::uint32_t level(const Item& item) const {
    constexpr std::uint64_t parts = 64;
    return static_cast<std::uint32_t>(parts * item.degree + parts * item.vertex / graph_.size());
  }

  // ---- Plan: the neighbours of the vertex. Reaches for them, and for what is in its lists ----
  bool plan(const Item& item, Plan& plan, auto& reach) const {
    if (!reach(item.vertex) || version_of_[item.vertex] != item.version) return false;
    plan.clique.clear();
    const auto add = [&](Vertex v) {
      if (!reach(v)) return false;
      if (v == item.vertex || !graph_.is_left(v)) return true;
      plan.clique.push_back(v);
      for (const Vertex other : graph_.list(v))
        if (!reach(other)) return false;
      return true;
    };
    for (const Vertex element : graph_.elements(item.vertex)) {
      if (!reach(element)) return false;
      for (const Vertex v : graph_.members(element))
        if (!add(v)) return false;
    }
    for (const Vertex v : graph_.neighbours(item.vertex))
      if (!add(v)) return false;
    return true;
  }
  // ---- Apply: the vertex becomes an element; degrees change ----
  void apply(const Item& item, Plan& plan, auto& commit) {
    std::vector<Vertex>& clique = plan.clique;
    std::sort(clique.begin(), clique.end());
    clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
    std::uint32_t step = step_of_[item.vertex];
    for (const Vertex v : clique) {
      step = std::max(step, step_of_[v]);
      ++version_of_[v];
    }
    ++version_of_[item.vertex];
    step_of_[item.vertex] = ++step;
    is_pivot_[item.vertex] = 1;
    graph_.eliminate(item.vertex, clique, plan.scratch);
    for (const Vertex v : clique) {
      step_of_[v] = step;
      commit.wake({v, graph_.degree(v), version_of_[v]});
    }
  }

  /// The resulting ordering: vertices sorted by step. Vertices of one step are not adjacent.
  Ordering ordering(const runtime::Executor& executor) const {
    std::vector<std::uint64_t> pivots;  // steps and vertices
    for (Vertex v = 0; v < graph_.size(); ++v)
      if (is_pivot_[v] != 0) pivots.push_back(std::uint64_t{step_of_[v]} << 32U | v);
    runtime::parallel_sort(executor, std::span(pivots));
    Ordering result;
    for (const std::uint64_t pivot : pivots) {
      const auto vertex = static_cast<Vertex>(pivot);
      const std::size_t before = result.order.size();
      graph_.for_each_of(vertex, [&](Vertex v) { result.order.push_back(v); });
      const std::uint64_t count = result.order.size() - before;
      result.fill += count * graph_.degree(vertex) + count * (count + 1) / 2;
    }
    return result;
  }

 private:
  QuotientGraph graph_;
  std::vector<std::uint32_t> version_of_;  // [vertex], how often its neighbours have changed
  std::vector<std::uint32_t> step_of_;     // [vertex], greater than those of all before it
  std::vector<std::uint8_t> is_pivot_;     // [vertex], was eliminated by an item of its own
};

/// Returns the ordering; fills in a report if there is one.
inline Ordering minimum_degree_in_parallel(const runtime::Executor& executor,
                                           runtime::CsrGraph<> graph,
                                           runtime::RoundsReport* report = nullptr) {
  MinimumDegree elimination(graph);
  const runtime::RoundsReport rounds =
      runtime::run_rounds(executor, elimination, elimination.all_items());
  if (report != nullptr) *report = rounds;
  return elimination.ordering(executor);
}

}  // namespace example
