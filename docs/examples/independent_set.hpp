/// @file
/// A maximal independent set: no two of its vertices are neighbours, and no vertex can be added.
/// This is the smallest operator: a vertex joins unless a neighbour has joined. Vertices are taken
/// in the order of their numbers, so the set is that of a plain loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

class IndependentSet {
 public:
  using Item = Vertex;
  struct Plan {};

  explicit IndependentSet(runtime::CsrGraph<> graph)
      : member(graph.vertex_count()), graph_(graph), is_decided_(graph.vertex_count()) {}

  // ---- Resources: vertices. An item only marks its neighbours ----
  std::size_t resource_count() const { return member.size(); }
  void conflicts(Vertex vertex, auto&& visit) const { graph_.for_each_neighbour(vertex, visit); }

  // ---- Plan: join unless a neighbour has joined. Reads only what it has reached ----
  bool plan(Vertex vertex, Plan&, auto& reach) const {
    if (!reach(vertex)) return false;
    for (std::uint32_t i = graph_.offset[vertex]; i < graph_.offset[vertex + 1]; ++i)
      if (!reach(graph_.neighbour[i])) return false;
    return is_decided_[vertex] == 0;
  }
  // ---- Apply ----
  void apply(Vertex vertex, Plan&, auto& /*commit*/) {
    member[vertex] = is_decided_[vertex] = 1;
    graph_.for_each_neighbour(vertex,
                              [&](Vertex other) { runtime::atomic_set(is_decided_[other]); });
  }

  std::vector<std::uint8_t> member;  // [vertex]

 private:
  runtime::CsrGraph<> graph_;
  std::vector<std::uint8_t> is_decided_;  // [vertex], is in the set or beside it
};

/// Checks that no member has a member as neighbour, and that all other vertices have one.
inline bool is_maximal_independent(runtime::CsrGraph<> graph,
                                   const std::vector<std::uint8_t>& member) {
  for (Vertex vertex = 0; vertex < member.size(); ++vertex) {
    bool beside_member = false;
    graph.for_each_neighbour(vertex, [&](Vertex other) { beside_member |= member[other] != 0; });
    if (beside_member == (member[vertex] != 0)) return false;
  }
  return true;
}

/// Returns [vertex], 1 for the members; fills in a report if there is one.
inline std::vector<std::uint8_t> independent_set_in_parallel(
    const runtime::Executor& executor, runtime::CsrGraph<> graph,
    runtime::RoundsReport* report = nullptr) {
  IndependentSet set(graph);
  const runtime::RoundsReport rounds =
      runtime::run_rounds(executor, set, runtime::AllNumbers(graph.vertex_count()));
  if (report) *report = rounds;
  return std::move(set.member);
}

}  // namespace example
