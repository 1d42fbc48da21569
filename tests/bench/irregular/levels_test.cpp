/// @file
/// The examples that run by levels, beside the serial codes.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "lean/shortest_paths.hpp"
#include "shortest_paths.hpp"

namespace {

using namespace example;
namespace runtime = ductile::runtime;

constexpr int thread_counts[] = {1, 2, 3, 4, 8};

/// A random graph; weights of odd seeds are few, 0 among them.
WeightedGraph weighted_graph(std::uint64_t seed, std::size_t vertex_count) {
  const auto random = [&](std::size_t i) { return runtime::mix64(seed << 32U | i); };
  const runtime::Executor executor({.threads = 1});
  runtime::CsrRows rows =
      graph_of_edges(executor, vertex_count, random(0) % (4 * vertex_count), [&](std::size_t e) {
        return std::pair(static_cast<Vertex>(random(2 * e + 1) % vertex_count),
                         static_cast<Vertex>(random(2 * e + 2) % vertex_count));
      });
  WeightedGraph graph = with_random_weights(std::move(rows));
  if (seed % 2 == 1)
    for (Weight& weight : graph.weight_of) weight %= 4;
  return graph;
}

std::vector<WeightedGraph> large_graphs() {
  const runtime::Executor executor({.threads = 1});
  std::vector<WeightedGraph> graphs;
  graphs.push_back(geometric_graph(20000));
  graphs.push_back(with_random_weights(grid_graph(20000)));
  graphs.push_back(with_random_weights(rmat_graph(executor, 13, 60000)));
  graphs.push_back(weighted_graph(7, 20000));
  return graphs;
}

TEST(ShortestPaths, AreDijkstras) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const WeightedGraph graph = weighted_graph(seed, 1 + seed % 70);
    const auto source = static_cast<Vertex>(seed % graph.rows.vertex_count());
    const auto expected = lean::shortest_paths(graph.rows.view(), graph.weight_of, source);
    for (const int threads : thread_counts)
      ASSERT_EQ(shortest_paths_in_parallel(runtime::Executor({.threads = threads}),
                                           graph.rows.view(), graph.weight_of, source),
                expected)
          << seed << ", " << threads << " threads";
  }
}

TEST(ShortestPaths, AreDijkstrasOnLargeGraphs) {
  for (const WeightedGraph& graph : large_graphs()) {
    const auto expected = lean::shortest_paths(graph.rows.view(), graph.weight_of, 0);
    for (const int threads : thread_counts)
      ASSERT_EQ(shortest_paths_in_parallel(runtime::Executor({.threads = threads}),
                                           graph.rows.view(), graph.weight_of, 0),
                expected)
          << threads << " threads";
  }
}

TEST(ShortestPaths, DoNotDependOnHowWideLevelsAre) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const WeightedGraph graph = weighted_graph(seed, 2000);
    const auto expected = lean::shortest_paths(graph.rows.view(), graph.weight_of, 0);
    for (const unsigned bits : {0U, 2U, 10U, 15U, 31U})
      for (const int threads : thread_counts) {
        ShortestPaths paths(graph.rows.view(), graph.weight_of, bits);
        const std::vector start{paths.start(0)};
        runtime::run_rounds(runtime::Executor({.threads = threads}), paths, start);
        ASSERT_EQ(paths.distance_of, expected) << bits << ", " << threads << " threads";
      }
  }
}

TEST(ShortestPaths, KeepTheContract) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const WeightedGraph graph = weighted_graph(seed, 1 + seed % 70);
    ShortestPaths paths(graph.rows.view(), graph.weight_of,
                        level_bits(graph.rows.view(), graph.weight_of));
    const std::vector start{paths.start(0)};
    runtime::run_rounds_checked(runtime::Executor(), paths, start);
    ASSERT_EQ(paths.distance_of, lean::shortest_paths(graph.rows.view(), graph.weight_of, 0));
  }
}

}  // namespace
