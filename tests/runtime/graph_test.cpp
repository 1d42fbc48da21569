#include "ductile/runtime/graph.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "graphs.hpp"

namespace ductile::runtime {
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
  const auto same = callback_graph(rows.vertex_count(), [&](std::uint32_t v, auto&& visit) {
    rows.for_each_neighbour(v, visit);
  });
  static_assert(Graph<decltype(same)>);
  for (std::uint32_t v = 0; v < 16; ++v) EXPECT_EQ(neighbours(same, v), neighbours(rows, v));
  EXPECT_EQ(CsrGraph<>{}.vertex_count(), 0U);
}

TEST(Graph, SquareJoinsVerticesTwoEdgesApart) {
  const auto path = test::path_graph(6);
  const CsrGraph<> rows = path.view();
  const SquareGraph square(rows);
  EXPECT_EQ(neighbours(square, 2), (std::multiset<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(neighbours(square, 0), (std::multiset<std::uint32_t>{1, 2}));
}

}  // namespace
}  // namespace ductile::runtime
