/// @file
/// Tests of the examples that run by levels, against the serial codes.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "lean/minimum_degree.hpp"
#include "lean/shortest_paths.hpp"
#include "minimum_degree.hpp"
#include "shortest_paths.hpp"

namespace {

using namespace example;
namespace runtime = ductile::runtime;

constexpr int thread_counts[] = {1, 2, 3, 4, 8};

/// A random graph. Odd seeds give few different weights, including 0.
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

/// Runs all rounds on several threads; a whole run does that only where it was faster so far.
template <class Op>
void run_at_once(int threads, Op& op, const std::vector<typename Op::Item>& work) {
  runtime::detail::run_by_level(runtime::Executor({.threads = threads}), op, work,
                                std::numeric_limits<std::size_t>::max(),
                                runtime::detail::Sharing::always);
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
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const WeightedGraph graph = weighted_graph(seed, 2000);
    const auto expected = lean::shortest_paths(graph.rows.view(), graph.weight_of, 0);
    for (const unsigned bits : {0U, 2U, 10U, 15U, 31U})
      for (const int threads : thread_counts) {
        ShortestPaths paths(graph.rows.view(), graph.weight_of, bits);
        const std::vector start{paths.start(0)};
        run_at_once(threads, paths, start);
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

// ---- Minimum degree ----

/// Eliminates vertices one by one; returns the entries of the factor, or 0 if the order is no
/// permutation.
std::uint64_t entries(const runtime::CsrRows& rows, const std::vector<Vertex>& order) {
  if (std::set(order.begin(), order.end()).size() != rows.vertex_count()) return 0;
  std::vector<std::set<Vertex>> beside(rows.vertex_count());
  for (Vertex v = 0; v < rows.vertex_count(); ++v)
    beside[v].insert(rows.view().row(v).begin(), rows.view().row(v).end());
  std::uint64_t sum = 0;
  for (const Vertex gone : order) {
    sum += 1 + beside[gone].size();
    for (const Vertex v : beside[gone]) {
      beside[v].insert(beside[gone].begin(), beside[gone].end());
      beside[v].erase(v);
      beside[v].erase(gone);
    }
  }
  return sum;
}

TEST(MinimumDegree, OrdersAllAndCountsTheFill) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const runtime::CsrRows rows = weighted_graph(seed, 1 + seed % 70).rows;
    const Ordering one = minimum_degree_in_parallel(runtime::Executor({.threads = 1}), rows.view());
    ASSERT_EQ(entries(rows, one.order), one.fill) << seed;
    for (const int threads : thread_counts) {
      MinimumDegree at_once(rows.view());
      run_at_once(threads, at_once, at_once.all_items());
      ASSERT_EQ(at_once.ordering(runtime::Executor()), one) << seed << ", " << threads;
    }
  }
}

TEST(MinimumDegree, IsTheSameAtAnyNumberOfThreads) {
  std::vector<runtime::CsrRows> graphs;
  graphs.push_back(grid_graph(2500));
  graphs.push_back(geometric_graph(2500).rows);
  graphs.push_back(weighted_graph(4, 300).rows);
  for (const runtime::CsrRows& rows : graphs) {
    const Ordering one = minimum_degree_in_parallel(runtime::Executor({.threads = 1}), rows.view());
    for (const int threads : thread_counts) {
      const runtime::Executor executor({.threads = threads});
      ASSERT_EQ(minimum_degree_in_parallel(executor, rows.view()), one) << threads << " threads";
      MinimumDegree at_once(rows.view());
      run_at_once(threads, at_once, at_once.all_items());
      ASSERT_EQ(at_once.ordering(executor), one) << threads << " threads";
    }
  }
}

TEST(MinimumDegree, HasHardlyMoreFillThanSerially) {
  for (const runtime::CsrRows& rows : {grid_graph(90000), geometric_graph(20000).rows}) {
    const Ordering ordering = minimum_degree_in_parallel(runtime::Executor(), rows.view());
    const std::uint64_t serial = lean::MinimumDegree(rows.view()).run().fill;
    EXPECT_LE(20 * ordering.fill, 21 * serial);
  }
}

TEST(MinimumDegree, KeepsTheContract) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const runtime::CsrRows rows = weighted_graph(seed, 1 + seed % 70).rows;
    MinimumDegree elimination(rows.view());
    runtime::run_rounds_checked(runtime::Executor(), elimination, elimination.all_items());
    ASSERT_EQ(elimination.ordering(runtime::Executor()),
              minimum_degree_in_parallel(runtime::Executor({.threads = 2}), rows.view()))
        << seed;
  }
}

}  // namespace
