/// @file
/// A maximal matching, serially: takes each edge in order, unless one of its ends is matched
/// already.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../graphs.hpp"

namespace lean {

/// Returns the numbers of the edges, ascending.
inline std::vector<std::uint32_t> matching(std::size_t vertex_count,
                                           std::span<const example::Edge> edges) {
  std::vector<std::uint8_t> taken(vertex_count);
  std::vector<std::uint32_t> matched;
  matched.reserve(vertex_count / 2);
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    if (a == b || taken[a] != 0 || taken[b] != 0) continue;
    taken[a] = taken[b] = 1;
    matched.push_back(e);
  }
  return matched;
}

}  // namespace lean
