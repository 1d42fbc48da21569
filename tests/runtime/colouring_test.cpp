#include "ductile/runtime/colouring.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "graphs.hpp"

namespace ductile::runtime {
namespace {

constexpr ColouringMethod methods[] = {
    ColouringMethod::automatic,     ColouringMethod::serial,           ColouringMethod::by_priority,
    ColouringMethod::blocked,       ColouringMethod::detect_again,     ColouringMethod::two_phase,
    ColouringMethod::largest_first, ColouringMethod::largest_log_first};

std::uint32_t greatest_degree(const test::TestGraph& graph) {
  std::uint32_t greatest = 0;
  for (std::size_t v = 0; v + 1 < graph.offset.size(); ++v)
    greatest = std::max(greatest, graph.offset[v + 1] - graph.offset[v]);
  return greatest;
}

TEST(Colouring, GivesNeighboursDifferentColours) {
  for (const auto& graph : test::test_graphs())
    for (const ColouringMethod method : methods)
      for (int threads : {1, 2, 4, 8}) {
        const Executor executor({.threads = threads, .deterministic = false});
        const Colouring colouring = colour(executor, graph.view(), method);
        EXPECT_TRUE(is_proper(executor, graph.view(), colouring)) << graph.name;
        EXPECT_TRUE(test::edges_are_properly_coloured(graph, colouring.colour_of, Colouring::none))
            << graph.name << ", method " << static_cast<int>(method) << ", threads " << threads;
        EXPECT_LE(colouring.count, greatest_degree(graph) + 1) << graph.name;
      }
}

TEST(Colouring, IsTheSameAtAnyThreadCountUnlessItSpeculates) {
  for (const auto& graph : test::test_graphs())
    for (const ColouringMethod method :
         {ColouringMethod::automatic, ColouringMethod::serial, ColouringMethod::by_priority,
          ColouringMethod::largest_first, ColouringMethod::largest_log_first}) {
      const Colouring first = colour(Executor({.threads = 1}), graph.view(), method);
      for (int threads : {2, 3, 4, 8})
        EXPECT_EQ(colour(Executor({.threads = threads}), graph.view(), method).colour_of,
                  first.colour_of)
            << graph.name << ", threads " << threads;
    }
}

TEST(Colouring, IsTheSameInEveryRun) {
  const auto graph = test::shuffled(test::mesh_graph(90), 6);
  const Executor executor({.threads = 4});
  const Colouring first = colour(executor, graph.view(), ColouringMethod::blocked);
  for (int run = 0; run < 20; ++run)
    EXPECT_EQ(colour(executor, graph.view(), ColouringMethod::blocked).colour_of, first.colour_of);
}

TEST(Colouring, NeedsFewColoursOnAMesh) {
  const auto mesh = test::mesh_graph(200);
  for (const ColouringMethod method : methods)
    EXPECT_LE(colour(Executor({.threads = 4}), mesh.view(), method).count, 7U);
  const auto wild = test::shuffled(mesh, 1);
  for (const ColouringMethod method : methods)
    EXPECT_LE(colour(Executor({.threads = 4}), wild.view(), method).count, 7U);
}

TEST(Colouring, OfTheSquareSeparatesVerticesTwoEdgesApart) {
  const auto mesh = test::shuffled(test::mesh_graph(80), 3);
  const CsrGraph<> rows = mesh.view();
  for (const ColouringMethod method : methods)
    for (int threads : {1, 3}) {
      const Executor executor({.threads = threads});
      const Colouring colouring = colour(executor, SquareGraph(rows), method);
      EXPECT_TRUE(is_proper(executor, SquareGraph(rows), colouring));
      for (std::uint32_t v = 0; v < rows.vertex_count(); ++v) {
        std::vector<std::uint32_t> around{colouring.colour_of[v]};
        rows.for_each_neighbour(v,
                                [&](std::uint32_t u) { around.push_back(colouring.colour_of[u]); });
        std::sort(around.begin(), around.end());
        EXPECT_EQ(std::adjacent_find(around.begin(), around.end()), around.end());
      }
    }
}

/// The vertices of a graph whose hash leaves a remainder below `share` of 16.
std::vector<std::uint32_t> some_vertices(const test::TestGraph& graph, std::uint32_t share) {
  std::vector<std::uint32_t> some;
  for (std::uint32_t v = 0; v + 1 < graph.offset.size(); ++v)
    if (mix32(v) % 16 < share) some.push_back(v);
  return some;
}

TEST(Recolour, KeepsTheOthersAndIsTheSameAtAnyThreadCount) {
  for (const auto& graph : test::test_graphs())
    for (std::uint32_t share : {1U, 12U}) {
      const auto some = some_vertices(graph, share);
      Colouring start = colour(Executor({.threads = 1}), graph.view());
      Colouring first;
      for (int threads : {1, 2, 3, 8}) {
        const Executor executor({.threads = threads});
        Colouring now = start;
        recolour(executor, graph.view(), some, now);
        EXPECT_TRUE(is_proper(executor, graph.view(), now)) << graph.name;
        if (threads == 1) first = now;
        EXPECT_EQ(now.colour_of, first.colour_of) << graph.name << ", threads " << threads;
      }
      for (const std::uint32_t v : some) first.colour_of[v] = start.colour_of[v];
      EXPECT_EQ(first.colour_of, start.colour_of) << graph.name;
    }
}

TEST(Recolour, ColoursAPartAsIfTheRestWereNotThere) {
  for (const auto& graph : test::test_graphs())
    for (int threads : {1, 4}) {
      const auto some = some_vertices(graph, 9);
      Colouring part{std::vector<std::uint32_t>(graph.view().vertex_count(), Colouring::none), 0};
      recolour(Executor({.threads = threads}), graph.view(), some, part);
      EXPECT_TRUE(test::edges_are_properly_coloured(graph, part.colour_of, Colouring::none));
      std::size_t coloured = 0;
      for (const std::uint32_t c : part.colour_of) coloured += c < part.count;
      EXPECT_EQ(coloured, some.size());
    }
}

TEST(ColourClasses, HoldTheVerticesOfEachColourInOrder) {
  for (const auto& graph : test::test_graphs())
    for (int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      Colouring colouring = colour(executor, graph.view());
      if (!colouring.colour_of.empty()) colouring.colour_of[0] = Colouring::none;
      const ColourClasses classes = colour_classes(executor, colouring);
      ASSERT_EQ(classes.count(), colouring.count);
      for (std::uint32_t c = 0; c < colouring.count; ++c) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t v = 0; v < colouring.colour_of.size(); ++v)
          if (colouring.colour_of[v] == c) expected.push_back(v);
        EXPECT_EQ(std::vector(classes.members(c).begin(), classes.members(c).end()), expected);
      }
    }
}

TEST(IsProper, RefusesClashesAndMissingColours) {
  const auto path = test::path_graph(3);
  const Executor executor({.threads = 1});
  EXPECT_TRUE(is_proper(executor, path.view(), {{0, 1, 0}, 2}));
  EXPECT_FALSE(is_proper(executor, path.view(), {{0, 0, 1}, 2}));
  EXPECT_FALSE(is_proper(executor, path.view(), {{0, 1, Colouring::none}, 2}));
  EXPECT_FALSE(is_proper(executor, path.view(), {{0, 1}, 2}));
}

}  // namespace
}  // namespace ductile::runtime
