/// @file
/// Shortest paths from one vertex, level by level (delta stepping: Meyer & Sanders, J. Algorithms
/// 49, 2003). An item is a vertex and a distance at which it can be reached; its level is that
/// distance in units of some width. It tells its neighbours how near they are through it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic_min.hpp"
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

  /// Paths are shorter than 2^32 - 1.
  ShortestPaths(runtime::CsrGraph<> graph, std::span<const Weight> weight_of, Weight width)
      : distance_of(graph.vertex_count(), unreachable),
        graph_(graph),
        weight_of_(weight_of),
        width_(width) {}

  Item start(Vertex source) { return {source, distance_of[source] = 0}; }

  // ---- Resources: vertices. The distance of a neighbour is only lowered ----
  static constexpr bool lowers_minima = true;
  std::size_t resource_count() const { return distance_of.size(); }
  std::uint32_t level(const Item& item) const { return item.distance / width_; }

  // ---- Plan: go on from the vertex, unless there was a shorter way. Reads only ----
  bool plan(const Item& item, Plan&, auto& reach) const {
    return reach(item.vertex) && distance_of[item.vertex] == item.distance;
  }
  // ---- Apply: whoever comes nearer is an item ----
  void apply(const Item& item, Plan&, auto& commit) {
    for (std::uint32_t arc = graph_.offset[item.vertex]; arc < graph_.offset[item.vertex + 1];
         ++arc) {
      const Item next{graph_.neighbour[arc], item.distance + weight_of_[arc]};
      if (runtime::atomic_min(distance_of[next.vertex], next.distance)) commit.wake(next);
    }
  }

  std::vector<Distance> distance_of;  // [vertex]

 private:
  runtime::CsrGraph<> graph_;
  std::span<const Weight> weight_of_;  // [arc]
  Weight width_;
};

/// A level so wide that, where an arc leads, about four others are no longer than it: where there
/// are more, many are gone along in vain; with fewer, there is little to do at once. From a sample
/// of the arcs.
inline Weight level_width(runtime::CsrGraph<> graph, std::span<const Weight> weight_of) {
  constexpr double others = 4;
  constexpr std::size_t most_arcs = 65536;
  const std::size_t step = weight_of.size() / most_arcs + 1;
  double weights = 0, degrees = 0;
  for (std::size_t arc = 0; arc < weight_of.size(); arc += step) {
    const Vertex end = graph.neighbour[arc];
    weights += weight_of[arc];
    degrees += graph.offset[end + 1] - graph.offset[end];
  }
  // Weights are taken to be spread evenly from 0 to twice their mean.
  const double width = degrees == 0 ? 1 : 2 * weights * others / degrees;
  return static_cast<Weight>(std::clamp(width, 1.0, 1e9));
}

/// [vertex], the length of the shortest path from `source`, or ShortestPaths::unreachable; fills in
/// a report if there is one.
inline std::vector<Distance> shortest_paths_in_parallel(const runtime::Executor& executor,
                                                        runtime::CsrGraph<> graph,
                                                        std::span<const Weight> weight_of,
                                                        Vertex source,
                                                        runtime::RoundsReport* report = nullptr) {
  ShortestPaths paths(graph, weight_of, level_width(graph, weight_of));
  const std::vector<ShortestPaths::Item> start{paths.start(source)};
  const runtime::RoundsReport rounds = runtime::run_rounds(executor, paths, start);
  if (report != nullptr) *report = rounds;
  return std::move(paths.distance_of);
}

}  // namespace example
