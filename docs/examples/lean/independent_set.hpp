/// @file
/// A maximal independent set, serially: each vertex in order joins, unless an earlier neighbour has
/// joined. Only members visit their neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "../graphs.hpp"

namespace lean {

/// Returns [vertex], 1 for the members.
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
