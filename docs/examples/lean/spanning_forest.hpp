/// @file
/// A spanning forest, serially: takes each edge in order if its ends are in different trees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../graphs.hpp"
#include "disjoint_sets.hpp"

namespace lean {

/// Returns the numbers of the edges, ascending.
inline std::vector<std::uint32_t> spanning_forest(std::size_t vertex_count,
                                                  std::span<const example::Edge> edges) {
  DisjointSets trees(vertex_count);
  std::vector<std::uint32_t> forest;
  forest.reserve(vertex_count);
  for (std::uint32_t e = 0; e < edges.size() && forest.size() + 1 < vertex_count; ++e)
    if (trees.join(edges[e].a, edges[e].b)) forest.push_back(e);
  return forest;
}

}  // namespace lean
