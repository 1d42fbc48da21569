/// @file
/// The minimum spanning forest of a graph (Kruskal, 1956): edges are sorted by weight, and the
/// forest of spanning_forest.hpp is made in that order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/run_rounds.hpp"
#include "ductile/runtime/sort.hpp"
#include "graphs.hpp"
#include "spanning_forest.hpp"

namespace example {

namespace runtime = ductile::runtime;

/// Work: the numbers of edges in the lower halves of sorted keys.
class EdgesByKey {
 public:
  explicit EdgesByKey(std::span<const std::uint64_t> keys) : keys_(keys) {}
  std::size_t size() const { return keys_.size(); }
  std::uint32_t operator[](std::size_t i) const { return static_cast<std::uint32_t>(keys_[i]); }

 private:
  std::span<const std::uint64_t> keys_;
};

/// The numbers of the forest's edges, ascending by weight, then number; fills in a report if there
/// is one.
inline std::vector<std::uint32_t> spanning_tree_in_parallel(
    const runtime::Executor& executor, std::size_t vertex_count, const std::vector<Edge>& edges,
    std::span<const Weight> weight_of, runtime::RoundsReport* report = nullptr) {
  std::vector<std::uint64_t> keys(edges.size());
  runtime::parallel_for(executor, edges.size(),
                        [&](std::size_t e) { keys[e] = std::uint64_t{weight_of[e]} << 32U | e; });
  runtime::parallel_sort_above(executor, std::span(keys), 32);
  SpanningForest forest(executor, vertex_count, edges);
  return runtime::applied_in_order(executor, forest, EdgesByKey(keys), report);
}

}  // namespace example
