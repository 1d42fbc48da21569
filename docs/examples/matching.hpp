/// @file
/// A maximal matching: no two of its edges share a vertex, and no edge can be added. Edges are
/// taken in order, so the matching is that of a plain loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

class Matching {
 public:
  // ---- Items: the numbers of edges ----
  using Item = std::uint32_t;
  using Plan = Edge;

  Matching(std::size_t vertex_count, const std::vector<Edge>& edges)
      : edges_(edges), is_taken_(vertex_count) {}

  // ---- Resources: vertices ----
  std::size_t resource_count() const { return is_taken_.size(); }
  // ---- Plan: match two vertices if both are free. Reads only what it has reached ----
  bool plan(Item number, Edge& edge, auto& reach) const {
    edge = edges_[number];
    return edge.a != edge.b && reach(edge.a) && is_taken_[edge.a] == 0 && reach(edge.b) &&
           is_taken_[edge.b] == 0;
  }
  // ---- Apply ----
  void apply(Item, const Edge& edge, auto& /*commit*/) {
    is_taken_[edge.a] = is_taken_[edge.b] = 1;
  }

 private:
  const std::vector<Edge>& edges_;
  std::vector<std::uint8_t> is_taken_;  // [vertex]
};

/// The numbers of the matching's edges, ascending; fills in a report if there is one.
inline std::vector<std::uint32_t> matching_in_parallel(const runtime::Executor& executor,
                                                       std::size_t vertex_count,
                                                       const std::vector<Edge>& edges,
                                                       runtime::RoundsReport* report = nullptr) {
  Matching matching(vertex_count, edges);
  return runtime::applied_in_order(executor, matching, runtime::AllNumbers(edges.size()), report);
}

}  // namespace example
