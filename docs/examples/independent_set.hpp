/// @file
/// A maximal independent set: vertices of a graph of which no two are neighbours, and to which none
/// can be added. The smallest operator there is: run_rounds colours the graph, and class by class
/// each vertex joins unless a neighbour has. Nothing is deferred, nobody is woken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

class IndependentSet {
 public:
  // ---- What it works on ----
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr bool keeps_conflicts = true;   // the graph stays as it is
  static constexpr bool plans_on_its_own = true;  // a plan reads what neighbours write, no more

  explicit IndependentSet(runtime::CsrGraph<> graph)
      : member(graph.vertex_count()), graph_(graph) {}

  // ---- Plan: join, unless it or a neighbour has. Reads only. ----
  std::optional<Plan> plan(Vertex vertex) const {
    bool free = member[vertex] == 0;
    graph_.for_each_neighbour(vertex, [&](Vertex other) { free = free && member[other] == 0; });
    return free ? std::optional(vertex) : std::nullopt;
  }
  // ---- Conflict rule: of two neighbours, the second must see what the first did ----
  void conflicts(Vertex vertex, auto&& visit) const { graph_.for_each_neighbour(vertex, visit); }
  std::size_t item_count() const { return member.size(); }
  // ---- Apply: a vertex owns its own entry ----
  void apply(Plan vertex, auto& /*commit*/) { member[vertex] = 1; }
  // ---- Commit: nothing was deferred ----
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::uint8_t> member;  // [vertex]

 private:
  runtime::CsrGraph<> graph_;
};

/// Members have no member beside them, and all others have one.
inline bool is_maximal_independent(runtime::CsrGraph<> graph,
                                   const std::vector<std::uint8_t>& member) {
  for (Vertex vertex = 0; vertex < member.size(); ++vertex) {
    bool beside_member = false;
    graph.for_each_neighbour(vertex, [&](Vertex other) { beside_member |= member[other] != 0; });
    if (beside_member == (member[vertex] != 0)) return false;
  }
  return true;
}

/// [vertex], 1 for the members; fills in a report if there is one.
inline std::vector<std::uint8_t> independent_set_in_parallel(
    const runtime::Executor& executor, runtime::CsrGraph<> graph,
    runtime::RoundsReport* report = nullptr) {
  std::vector<Vertex> vertices(graph.vertex_count());
  std::iota(vertices.begin(), vertices.end(), Vertex{0});
  IndependentSet set(graph);
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, set, vertices);
  if (report) *report = rounds;
  return set.member;
}

}  // namespace example
