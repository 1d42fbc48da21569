#include "ductile/runtime/colouring/graph.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "graphs.hpp"

namespace ductile::runtime::any_graph_test {
namespace {

std::vector<std::uint32_t> row(const auto& graph, std::uint32_t v) {
  std::vector<std::uint32_t> all;
  graph.for_each_neighbour(v, [&](std::uint32_t u) { all.push_back(u); });
  return all;
}

/// Graphs with rows of 0, 1, 32, 33 and more neighbours.
std::vector<test::TestGraph> graphs() {
  return {test::star_graph(33), test::star_graph(34),  test::star_graph(1000),
          test::path_graph(5),  test::mesh_graph(120), test::random_graph(20000, 300000, 3)};
}

TEST(AnyGraph, ShowsTheNeighboursInTheirOrder) {
  for (const auto& graph : graphs()) {
    const CsrGraph<> rows = graph.view();
    const AnyGraph any(rows);
    ASSERT_EQ(any.vertex_count(), rows.vertex_count());
    for (std::uint32_t v = 0; v < graph.vertex_count(); ++v) EXPECT_EQ(row(any, v), row(rows, v));
  }
}

TEST(AnyGraph, HandsOnWhatTheGraphAndTheVisitorThrow) {
  const auto bad = CallbackGraph(3, [](std::uint32_t v, auto&& visit) {
    visit(v);
    if (v == 1) throw std::runtime_error("no row");
  });
  const AnyGraph any(bad);
  EXPECT_EQ(row(any, 0), std::vector<std::uint32_t>{0});
  EXPECT_THROW(row(any, 1), std::runtime_error);
  EXPECT_THROW(any.for_each_neighbour(0, [](std::uint32_t) { throw std::logic_error("enough"); }),
               std::logic_error);
}

/// A clique of 300 needs more colours than a byte holds.
TEST(AnyGraph, HasTheColoursOfTheGraphItShows) {
  const auto clique = CallbackGraph(300, [](std::uint32_t v, auto&& visit) {
    for (std::uint32_t u = 0; u < 300; ++u)
      if (u != v) visit(u);
  });
  const Executor executor({.threads = 2});
  for (const ColouringMethod method :
       {ColouringMethod::serial, ColouringMethod::automatic, ColouringMethod::by_priority}) {
    for (const auto& graph : graphs())
      EXPECT_EQ(colour(executor, AnyGraph(graph.view()), method).colour_of,
                colour(executor, graph.view(), method).colour_of)
          << graph.name;
    const Colouring direct = colour(executor, clique, method);
    EXPECT_EQ(direct.count, 300U);
    EXPECT_EQ(colour(executor, AnyGraph(clique), method).colour_of, direct.colour_of);
  }
}

TEST(AnyGraph, SpeculativeMethodsColourWhatNeedsLongWords) {
  const auto clique = CallbackGraph(300, [](std::uint32_t v, auto&& visit) {
    for (std::uint32_t u = 0; u < 300; ++u)
      if (u != v) visit(u);
  });
  const Executor executor({.threads = 2});
  for (const ColouringMethod method : {ColouringMethod::detect_again, ColouringMethod::two_phase}) {
    const Colouring colouring = colour(executor, clique, method);
    EXPECT_TRUE(is_proper(executor, clique, colouring));
    EXPECT_EQ(colouring.count, 300U);
  }
}

}  // namespace
}  // namespace ductile::runtime::any_graph_test
