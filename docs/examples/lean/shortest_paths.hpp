/// @file
/// Shortest paths from one vertex by Dijkstra's algorithm. Its queue is a radix heap (Ahuja,
/// Mehlhorn, Orlin & Tarjan, J. ACM 37, 1990): distances never fall below the last one taken, so
/// they wait in 33 bags, by the highest bit in which they differ from that one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "../graphs.hpp"

namespace lean {

constexpr std::uint32_t unreachable = 0xffffffffU;

class RadixHeap {
 public:
  /// The distance must not be below the last one taken.
  void push(std::uint32_t distance, example::Vertex vertex) {
    bags_[std::bit_width(distance ^ last_)].push_back(std::uint64_t{distance} << 32U | vertex);
  }
  /// Takes an entry of least distance: (distance, vertex) in the two halves of a word. False if
  /// empty.
  bool pop(std::uint64_t& least) {
    if (bags_[0].empty() && !refill()) return false;
    least = bags_[0].back();
    bags_[0].pop_back();
    return true;
  }

 private:
  /// Distributes the first non-empty bag among those before it.
  bool refill() {
    const auto bag = std::find_if(bags_.begin() + 1, bags_.end(),
                                  [](const auto& entries) { return !entries.empty(); });
    if (bag == bags_.end()) return false;
    last_ = static_cast<std::uint32_t>(*std::min_element(bag->begin(), bag->end()) >> 32U);
    for (const std::uint64_t entry : *bag)
      push(static_cast<std::uint32_t>(entry >> 32U), static_cast<example::Vertex>(entry));
    bag->clear();
    return true;
  }

  std::array<std::vector<std::uint64_t>, 33> bags_;
  std::uint32_t last_ = 0;
};

/// Returns [vertex], the length of the shortest path from `source`, or `unreachable`. Lengths must
/// be below 2^32 - 1.
inline std::vector<std::uint32_t> shortest_paths(ductile::runtime::CsrGraph<> graph,
                                                 std::span<const example::Weight> weight_of,
                                                 example::Vertex source) {
  std::vector<std::uint32_t> distance_of(graph.vertex_count(), unreachable);
  RadixHeap waiting;
  waiting.push(distance_of[source] = 0, source);
  for (std::uint64_t least = 0; waiting.pop(least);) {
    const auto distance = static_cast<std::uint32_t>(least >> 32U);
    const auto vertex = static_cast<example::Vertex>(least);
    if (distance != distance_of[vertex]) continue;  // a shorter path was found
    for (std::uint32_t arc = graph.offset[vertex]; arc < graph.offset[vertex + 1]; ++arc) {
      const example::Vertex other = graph.neighbour[arc];
      const std::uint32_t through = distance + weight_of[arc];
      if (through < distance_of[other]) waiting.push(distance_of[other] = through, other);
    }
  }
  return distance_of;
}

}  // namespace lean
