#include "ductile/runtime/colouring/graph.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "graphs.hpp"

namespace ductile::runtime::graph_test {
namespace {

template <Graph G>
std::multiset<std::uint32_t> neighbours(const G& graph, std::uint32_t v) {
  std::multiset<std::uint32_t> all;
  graph.for_each_neighbour(v, [&](std::uint32_t u) { all.insert(u); });
  return all;
}

TEST(Graph, ViewsShowTheNeighbours) {
  const auto mesh = test::mesh_graph(4);
  const CsrGraph<> rows = mesh.view();
  EXPECT_EQ(rows.vertex_count(), 16U);
  EXPECT_EQ(neighbours(rows, 5), (std::multiset<std::uint32_t>{0, 1, 4, 6, 9, 10}));
  const auto same = CallbackGraph(rows.vertex_count(), [&](std::uint32_t v, auto&& visit) {
    rows.for_each_neighbour(v, visit);
  });
  static_assert(Graph<decltype(same)> && !PrefetchingGraph<decltype(same)>);
  static_assert(PrefetchingGraph<CsrGraph<>>);
  for (std::uint32_t v = 0; v < 16; ++v) EXPECT_EQ(neighbours(same, v), neighbours(rows, v));
  EXPECT_EQ(CsrGraph<>{}.vertex_count(), 0U);
}

TEST(Graph, RowsHoldBothDirectionsInTheOrderOfTheEdges) {
  const std::pair<std::uint32_t, std::uint32_t> edges[] = {{2, 0}, {0, 1}, {1, 1}, {0, 2}};
  const CsrRows rows = csr_rows(4, edges);
  EXPECT_EQ(rows.vertex_count(), 4U);
  EXPECT_EQ(rows.offset, (std::vector<std::uint32_t>{0, 3, 6, 8, 8}));
  EXPECT_EQ(rows.neighbour, (std::vector<std::uint32_t>{2, 1, 2, 0, 1, 1, 0, 0}));
  EXPECT_EQ(csr_rows(0, {}).view().vertex_count(), 0U);
  EXPECT_THROW(csr_rows(2, edges), std::out_of_range);
}

TEST(Graph, SquareJoinsVerticesTwoEdgesApart) {
  const auto path = test::path_graph(6);
  const CsrGraph<> rows = path.view();
  const SquareGraph square(rows);
  EXPECT_EQ(neighbours(square, 2), (std::multiset<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(neighbours(square, 0), (std::multiset<std::uint32_t>{1, 2}));
}

}  // namespace
}  // namespace ductile::runtime::graph_test
