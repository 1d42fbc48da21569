#include "support/graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

namespace ductile::bench {
namespace {

std::vector<std::uint32_t> sorted_degrees(const Rows& graph) {
  std::vector<std::uint32_t> degrees(graph.vertex_count());
  for (std::uint32_t v = 0; v < graph.vertex_count(); ++v)
    degrees[v] = graph.offset[v + 1] - graph.offset[v];
  std::sort(degrees.begin(), degrees.end());
  return degrees;
}

/// Mean distance in memory between neighbours.
double mean_stride(const EdgeList& list) {
  double sum = 0;
  for (const auto& [u, v] : list.edges) sum += std::abs(double(u) - double(v));
  return sum / static_cast<double>(list.edges.size());
}

TEST(Graphs, ArraysHoldBothDirectionsOfEveryEdge) {
  for (const GraphCase& graph_case : graph_cases()) {
    const Rows& graph = graph_of(graph_case, 10);
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (std::uint32_t v = 0; v < graph.vertex_count(); ++v)
      graph.view().for_each_neighbour(v, [&](std::uint32_t u) { directed.emplace(v, u); });
    for (const auto& [v, u] : directed) {
      EXPECT_NE(u, v) << graph_case.name;
      EXPECT_EQ(directed.count({v, u}), directed.count({u, v})) << graph_case.name;
    }
  }
}

TEST(Graphs, HaveAboutTheVerticesAskedFor) {
  for (const GraphCase& graph_case : graph_cases()) {
    const Rows& graph = graph_of(graph_case, 12);
    EXPECT_NEAR(std::log2(graph.vertex_count()), 12, 0.1) << graph_case.name;
  }
}

TEST(Graphs, AnotherOrderIsTheSameGraph) {
  const EdgeList flat = mesh(20, 2), solid = mesh(9, 3);
  EXPECT_EQ(sorted_degrees(rows(flat)), sorted_degrees(rows(in_random_order(flat))));
  EXPECT_EQ(sorted_degrees(rows(flat)), sorted_degrees(rows(along_hilbert_curve(flat, 20, 2))));
  EXPECT_EQ(sorted_degrees(rows(solid)), sorted_degrees(rows(along_hilbert_curve(solid, 9, 3))));
}

/// Consecutive points of the curve are neighbours, and neighbours are joined in a mesh.
TEST(Graphs, HilbertCurveNeverJumps) {
  for (const int dim : {2, 3}) {
    const Rows graph = rows(along_hilbert_curve(mesh(8, dim), 8, dim));
    for (std::uint32_t v = 0; v + 1 < graph.vertex_count(); ++v) {
      bool joined = false;
      graph.view().for_each_neighbour(v, [&](std::uint32_t u) { joined = joined || u == v + 1; });
      EXPECT_TRUE(joined) << dim << "D, vertex " << v;
    }
  }
}

TEST(Graphs, RandomOrderScattersNeighbours) {
  const EdgeList list = mesh(40, 2);
  EXPECT_GT(mean_stride(in_random_order(list)), 10 * mean_stride(list));
}

TEST(Graphs, RandomGeometricFindsEveryPairNearEnough) {
  // 12 neighbours on average, fewer at the border.
  const EdgeList list = random_geometric(20000);
  EXPECT_NEAR(2.0 * static_cast<double>(list.edges.size()) / list.vertex_count, 12, 0.5);
  std::set<std::pair<std::uint32_t, std::uint32_t>> once;
  for (const auto& [u, v] : list.edges)
    EXPECT_TRUE(once.emplace(std::min(u, v), std::max(u, v)).second);
}

TEST(Graphs, SkewedRmatHasHubs) {
  EXPECT_GT(sorted_degrees(rows(rmat(12, 9, 3, 3))).back(),
            4 * sorted_degrees(rows(rmat(12, 4, 4, 4))).back());
}

TEST(Graphs, AStarHasOneHubAndAPathTwoEnds) {
  const auto star_degrees = sorted_degrees(rows(star(100)));
  EXPECT_EQ(star_degrees.back(), 99U);
  EXPECT_EQ(star_degrees[98], 1U);
  const auto path_degrees = sorted_degrees(rows(path(100)));
  EXPECT_EQ(std::count(path_degrees.begin(), path_degrees.end(), 1U), 2);
  EXPECT_EQ(path_degrees.back(), 2U);
}

TEST(Graphs, RefuseVerticesThatAreNotThere) {
  EXPECT_THROW(rows({3, {{0, 3}}}), std::out_of_range);
}

}  // namespace
}  // namespace ductile::bench
