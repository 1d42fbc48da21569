#include "ductile/runtime/colouring/ordering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "graphs.hpp"

namespace ductile::runtime::ordering_test {
namespace {

constexpr VertexOrder orders[] = {VertexOrder::natural, VertexOrder::largest_first,
                                  VertexOrder::smallest_last};

std::vector<std::uint32_t> degrees_without(const CsrGraph<>& rows, const std::vector<bool>& gone) {
  std::vector<std::uint32_t> degree_of(rows.vertex_count());
  for (std::uint32_t v = 0; v < degree_of.size(); ++v)
    rows.for_each_neighbour(v, [&](std::uint32_t u) { degree_of[v] += u != v && !gone[u]; });
  return degree_of;
}

TEST(VertexOrder, NamesEveryVertexOnce) {
  for (const auto& graph : test::test_graphs())
    for (const VertexOrder order : orders) {
      std::vector<std::uint32_t> all = vertex_order(Executor({.threads = 2}), graph.view(), order);
      std::sort(all.begin(), all.end());
      ASSERT_EQ(all.size(), graph.view().vertex_count());
      for (std::uint32_t v = 0; v < all.size(); ++v) ASSERT_EQ(all[v], v) << graph.name;
    }
}

TEST(VertexOrder, LargestFirstDescends) {
  for (const auto& graph : test::test_graphs()) {
    const CsrGraph<> rows = graph.view();
    const auto degree_of = degrees_without(rows, std::vector<bool>(rows.vertex_count()));
    const auto all = vertex_order(Executor({.threads = 3}), rows, VertexOrder::largest_first);
    for (std::size_t i = 1; i < all.size(); ++i) {
      EXPECT_GE(degree_of[all[i - 1]], degree_of[all[i]]) << graph.name;
      if (degree_of[all[i - 1]] == degree_of[all[i]]) {
        EXPECT_LT(all[i - 1], all[i]) << graph.name;
      }
    }
  }
}

TEST(VertexOrder, SmallestLastTakesTheLeastDegreeOfWhatIsLeft) {
  for (const auto& graph :
       {test::random_graph(300, 900, 1), test::mesh_graph(17), test::star_graph(200),
        test::clique_graph(300, 20), test::rmat_graph(8, 900, 2)}) {
    const CsrGraph<> rows = graph.view();
    const auto all = vertex_order(Executor({.threads = 1}), rows, VertexOrder::smallest_last);
    std::vector<bool> gone(all.size());
    for (std::size_t i = all.size(); i-- > 0;) {
      const auto degree_of = degrees_without(rows, gone);
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_LE(degree_of[all[i]], degree_of[all[j]]) << graph.name;
      gone[all[i]] = true;
    }
  }
}

TEST(ColourInOrder, IsSerialFirstFitAtAnyThreadCount) {
  for (const auto& graph : test::test_graphs())
    for (const VertexOrder which : orders) {
      const CsrGraph<> rows = graph.view();
      const auto order = vertex_order(Executor({.threads = 1}), rows, which);
      const Colouring serial = colour_in_order(Executor({.threads = 1}), rows, order);
      EXPECT_TRUE(is_proper(Executor({.threads = 1}), rows, serial)) << graph.name;
      EXPECT_TRUE(test::edges_are_properly_coloured(graph, serial.colour_of, Colouring::none));
      for (const int threads : {2, 3, 4, 8})
        EXPECT_EQ(colour_in_order(Executor({.threads = threads}), rows, order).colour_of,
                  serial.colour_of)
            << graph.name << ", threads " << threads;
      if (which == VertexOrder::natural) {
        EXPECT_EQ(serial.colour_of,
                  colour(Executor({.threads = 1}), rows, ColouringMethod::serial).colour_of);
      }
    }
}

TEST(ColourInOrder, SmallestLastNeedsFewColours) {
  const Executor executor({.threads = 2});
  const auto count = [&](const test::TestGraph& graph, VertexOrder order) {
    return colour_in_order(executor, graph.view(), vertex_order(executor, graph.view(), order))
        .count;
  };
  // A path unravels from its ends: degeneracy 1. A mesh of triangles from its corners: 3.
  EXPECT_EQ(count(test::shuffled(test::path_graph(9000), 1), VertexOrder::smallest_last), 2U);
  EXPECT_EQ(count(test::star_graph(6000), VertexOrder::smallest_last), 2U);
  EXPECT_LE(count(test::shuffled(test::mesh_graph(110), 2), VertexOrder::smallest_last), 4U);
  const auto skewed = test::rmat_graph(13, 60000, 3);
  EXPECT_LE(count(skewed, VertexOrder::smallest_last), count(skewed, VertexOrder::natural));
}

TEST(ColourInOrder, RefusesWhatDoesNotNameEachVertexOnce) {
  const auto path = test::path_graph(3);
  for (const auto& order : {std::vector{0U, 1U}, std::vector{0U, 1U, 2U, 2U},
                            std::vector{0U, 1U, 1U}, std::vector{0U, 1U, 3U}})
    EXPECT_THROW(colour_in_order(Executor({.threads = 1}), path.view(), order),
                 std::invalid_argument);
}

}  // namespace
}  // namespace ductile::runtime::ordering_test
