/// @file
/// The minimum spanning forest by Kruskal's algorithm: one sort of the edges, by digits of their
/// weights, and disjoint sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../graphs.hpp"
#include "disjoint_sets.hpp"
#include "radix_sort.hpp"

namespace lean {

/// The numbers of the edges, ascending by weight, then number. There must be fewer than 2^32.
inline std::vector<std::uint32_t> kruskal(std::size_t vertex_count,
                                          std::span<const example::Edge> edges,
                                          std::span<const example::Weight> weight_of) {
  std::vector<std::uint64_t> keys(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) keys[e] = std::uint64_t{weight_of[e]} << 32U | e;
  sort_by_upper_half(keys);
  DisjointSets trees(vertex_count);
  std::vector<std::uint32_t> forest;
  forest.reserve(vertex_count);
  for (std::size_t k = 0; k < keys.size() && forest.size() + 1 < vertex_count; ++k) {
    const auto e = static_cast<std::uint32_t>(keys[k]);
    if (trees.join(edges[e].a, edges[e].b)) forest.push_back(e);
  }
  return forest;
}

}  // namespace lean
