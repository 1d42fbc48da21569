/// @file
/// A maximal independent set, serially: each vertex in order, unless a neighbour before it is in.
/// Only members look at their neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "../graphs.hpp"

namespace lean {

/// [vertex], 1 for the members.
inline std::vector<std::uint8_t> independent_set(ductile::runtime::CsrGraph<> graph) {
  std::vector<std::uint8_t> member(graph.vertex_count()), beside(graph.vertex_count());
  for (example::Vertex vertex = 0; vertex < member.size(); ++vertex) {
    if (beside[vertex] != 0) continue;
    member[vertex] = 1;
    for (const example::Vertex other : graph.row(vertex)) beside[other] = 1;
  }
  return member;
}

}  // namespace lean
