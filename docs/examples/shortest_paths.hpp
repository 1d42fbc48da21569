/// @file
/// Shortest paths from one vertex, level by level (delta stepping: Meyer & Sanders, J. Algorithms
/// 49, 2003). An item is a vertex and a distance at which it can be reached; its level is that
/// distance in units of a power of two. It lowers the distances of its neighbours.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "graphs.hpp"

namespace example {

namespace runtime = ductile::runtime;

using Distance = std::uint32_t;

class ShortestPaths {
 public:
  struct Item {
    Vertex vertex;
    Distance distance;
  };
  struct Plan {
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  static constexpr Distance unreachable = 0xffffffffU;

  /// Paths must be shorter than 2^32 - 1. Levels are 2^bits wide, with bits below 32.
  ShortestPaths(runtime::CsrGraph<> graph, std::span<const Weight> weight_of, unsigned bits)
      : distance_of(graph.vertex_count(), unreachable),
        graph_(graph),
        weight_of_(weight_of),
        bits_(bits) {}

  Item start(Vertex source) { return {source, distance_of[source] = 0}; }

  // ---- Resources: vertices. The distance of a neighbour is only lowered ----
  static constexpr bool lowers_minima = true;
  std::size_t resource_count() const { return distance_of.size(); }
  std::uint32_t level(const Item& item) const { return item.distance >> bits_; }

  // ---- Plan: continue from the vertex, unless there was a shorter path. Reads only ----
  bool plan(const Item& item, Plan&, auto& reach) const {
    return reach(item.vertex) && distance_of[item.vertex] == item.distance;
  }
  // ---- Apply: each vertex whose distance falls becomes an item ----
  void apply(const Item& item, Plan&, auto& commit) {
    const std::uint32_t end = graph_.offset[item.vertex + 1];
    for (std::uint32_t arc = graph_.offset[item.vertex]; arc < end; ++arc) {
      const Item next{graph_.neighbour[arc], item.distance + weight_of_[arc]};
      if (runtime::atomic_min(distance_of[next.vertex], next.distance)) commit.wake(next);
    }
  }

  std::vector<Distance> distance_of;  // [vertex]

 private:
  runtime::CsrGraph<> graph_;
  std::span<const Weight> weight_of_;  // [arc]
  unsigned bits_;
};

/// Width of levels, in bits, from a sample of the arcs: so that at the end of an arc about three
/// other arcs are no longer than it. With wider levels many arcs are relaxed in vain; with narrower
/// ones there is little to do in parallel.
inline unsigned level_bits(runtime::CsrGraph<> graph, std::span<const Weight> weight_of) {
  constexpr std::size_t most_arcs = 65536;
  const std::size_t step = weight_of.size() / most_arcs + 1;
  std::uint64_t weights = 0, degrees = 1;
  for (std::size_t arc = 0; arc < weight_of.size(); arc += step) {
    const Vertex end = graph.neighbour[arc];
    weights += weight_of[arc];
    degrees += graph.offset[end + 1] - graph.offset[end];
  }
  // Assumes that weights are spread evenly from 0 to twice their mean.
  const std::uint64_t width = 3 * 2 * weights / degrees;
  return std::min(31U, static_cast<unsigned>(std::bit_width(width)));
}

/// Returns [vertex], the length of the shortest path from `source`, or ShortestPaths::unreachable;
/// fills in a report if there is one.
inline std::vector<Distance> shortest_paths_in_parallel(const runtime::Executor& executor,
                                                        runtime::CsrGraph<> graph,
                                                        std::span<const Weight> weight_of,
                                                        Vertex source,
                                                        runtime::RoundsReport* report = nullptr) {
  ShortestPaths paths(graph, weight_of, level_bits(graph, weight_of));
  const std::vector<ShortestPaths::Item> start{paths.start(source)};
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, paths, start);
  if (report != nullptr) *report = rounds;
  return std::move(paths.distance_of);
}

}  // namespace example
