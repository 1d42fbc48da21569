#include "ductile/runtime/colouring/balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "graphs.hpp"

namespace ductile::runtime::balance_test {
namespace {

std::vector<std::size_t> sizes(const Colouring& colouring) {
  std::vector<std::size_t> size_of(colouring.count);
  for (const std::uint32_t colour : colouring.colour_of) ++size_of[colour];
  return size_of;
}

TEST(Balance, StaysProperAndOnlyEvensOut) {
  for (const auto& graph : test::test_graphs()) {
    const Executor executor({.threads = 4});
    const Colouring before = colour(executor, graph.view());
    Colouring after = before;
    balance(executor, graph.view(), after);
    EXPECT_TRUE(is_proper(executor, graph.view(), after)) << graph.name;
    EXPECT_TRUE(test::edges_are_properly_coloured(graph, after.colour_of, Colouring::none));
    EXPECT_EQ(after.count, before.count);
    if (before.count == 0) continue;
    const std::size_t fair = (before.colour_of.size() + before.count - 1) / before.count;
    const auto old_sizes = sizes(before), new_sizes = sizes(after);
    for (std::size_t c = 0; c < old_sizes.size(); ++c) {
      EXPECT_GE(new_sizes[c], std::min(old_sizes[c], fair)) << graph.name;
      EXPECT_LE(new_sizes[c], std::max(old_sizes[c], fair)) << graph.name;
    }
  }
}

TEST(Balance, IsTheSameAtAnyThreadCount) {
  for (const auto& graph : test::test_graphs()) {
    const Colouring start = colour(Executor({.threads = 1}), graph.view());
    Colouring first = start;
    balance(Executor({.threads = 1}), graph.view(), first);
    for (const int threads : {2, 3, 4, 8}) {
      Colouring now = start;
      balance(Executor({.threads = threads}), graph.view(), now);
      EXPECT_EQ(now.colour_of, first.colour_of) << graph.name << ", threads " << threads;
    }
  }
}

TEST(Balance, MakesClassesOfOneSizeWhereNeighboursAllow) {
  const auto graph = test::random_graph(20000, 60000, 5);
  const Executor executor({.threads = 2});
  Colouring colouring = colour(executor, graph.view());
  const auto before = sizes(colouring);
  EXPECT_GT(*std::max_element(before.begin(), before.end()), 4000U);
  balance(executor, graph.view(), colouring);
  const auto after = sizes(colouring);
  const std::size_t fair = (20000 + colouring.count - 1) / colouring.count;
  EXPECT_LE(*std::max_element(after.begin(), after.end()), fair + fair / 20);
  EXPECT_GE(*std::min_element(after.begin(), after.end()), fair - fair / 5);
}

TEST(Balance, LeavesVerticesWithoutColourAlone) {
  const auto graph = test::mesh_graph(60);
  const Executor executor({.threads = 2});
  Colouring colouring = colour(executor, graph.view());
  for (std::uint32_t v = 0; v < 3600; v += 3) colouring.colour_of[v] = Colouring::none;
  balance(executor, graph.view(), colouring);
  for (std::uint32_t v = 0; v < 3600; ++v)
    EXPECT_EQ(colouring.colour_of[v] == Colouring::none, v % 3 == 0);
  EXPECT_TRUE(test::edges_are_properly_coloured(graph, colouring.colour_of, Colouring::none));
}

TEST(Balance, DoesNothingWithoutPasses) {
  const auto graph = test::mesh_graph(60);
  const Executor executor({.threads = 2});
  Colouring colouring = colour(executor, graph.view());
  const auto before = colouring.colour_of;
  balance(executor, graph.view(), colouring, {.most_passes = 0});
  EXPECT_EQ(colouring.colour_of, before);
}

}  // namespace
}  // namespace ductile::runtime::balance_test
