/// @file
/// The automatic method: it gives serial's colours on many threads, by whichever way it chooses,
/// and at most one more where results may depend on timing.
#include "ductile/runtime/colouring/detail/together.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "graphs.hpp"

namespace ductile::runtime::together_test {
namespace {

using Words = std::vector<std::uint32_t>;
using Width = detail::FourBytes<detail::Together::marks>;

/// A box of side^3 vertices, each joined to the next in every direction and along the diagonals.
test::TestGraph box_graph(std::uint32_t side) {
  test::Edges edges;
  for (std::uint32_t v = 0; v < side * side * side; ++v)
    for (std::uint32_t step = 1; step < 8; ++step) {
      const std::uint32_t x = step & 1U, y = step >> 1U & 1U, z = step >> 2U;
      if (v % side + x < side && v / side % side + y < side && v / side / side + z < side)
        edges.emplace_back(v, v + x + side * (y + side * z));
    }
  return test::make_graph("box", side * side * side, std::move(edges));
}

/// A mesh of 2^bits vertices a side, numbered along a curve that completes each square before it
/// leaves it.
test::TestGraph curve_graph(unsigned bits) {
  const std::uint32_t side = 1U << bits;
  const auto place_of = [&](std::uint32_t v) {
    std::uint32_t place = 0;
    for (unsigned bit = 0; bit < bits; ++bit)
      place |= (v % side >> bit & 1U) << (2 * bit) | (v / side >> bit & 1U) << (2 * bit + 1);
    return place;
  };
  test::Edges edges = test::mesh_graph(side).edges;
  for (auto& [u, v] : edges) u = place_of(u), v = place_of(v);
  return test::make_graph("curve", side * side, std::move(edges));
}

/// Two sets of vertices, each vertex joined to all of the other set except its partner. Taking both
/// sets alternately, first-fit needs as many colours as there are pairs.
test::TestGraph crown_graph(std::uint32_t vertices, std::uint32_t pairs) {
  test::Edges edges;
  for (std::uint32_t u = 0; u < pairs; ++u)
    for (std::uint32_t v = 0; v < pairs; ++v)
      if (u != v) edges.emplace_back(2 * u, 2 * v + 1);
  return test::make_graph("crown", vertices, std::move(edges));
}

/// Enough vertices to be coloured by many threads.
std::vector<test::TestGraph> large_graphs() {
  std::vector<test::TestGraph> graphs{test::random_graph(40'000, 160'000, 1),
                                      test::random_graph(33'000, 500'000, 2),
                                      test::rmat_graph(16, 400'000, 3),
                                      test::mesh_graph(600),
                                      test::star_graph(40'000),
                                      test::path_graph(40'000),
                                      test::path_graph(40'001),
                                      test::clique_graph(40'000, 300),
                                      box_graph(33),
                                      curve_graph(8),
                                      crown_graph(40'000, 150),
                                      test::make_graph("lone vertices", 40'000, {})};
  for (const std::size_t i : {2U, 3U, 5U, 8U, 10U})
    graphs.push_back(test::shuffled(graphs[i], static_cast<unsigned>(10 + i)));
  return graphs;
}

Words by_one_thread(const test::TestGraph& graph) {
  return colour(Executor({.threads = 1}), graph.view(), ColouringMethod::serial).colour_of;
}

TEST(Together, WindowsOfAnySizeGiveTheColoursOfOneThread) {
  for (const auto& graph : test::test_graphs()) {
    if (graph.vertex_count() == 0) continue;
    const Words expected = by_one_thread(graph);
    for (const std::uint32_t size : {16U, 440U, 1000U})
      for (const int threads : {1, 2, 3, 8, 20}) {
        const Executor executor({.threads = threads});
        Words words(expected.size(), Colouring::none);
        detail::WindowsRun(executor, graph.view(), detail::Colours<Width>(words), size).run();
        EXPECT_EQ(words, expected) << graph.name << ", " << size << ", threads " << threads;
      }
  }
}

TEST(Together, PartsGiveTheColoursOfOneThread) {
  for (const auto& graph : test::test_graphs()) {
    if (graph.vertex_count() == 0) continue;
    const Words expected = by_one_thread(graph);
    for (const int threads : {1, 2, 3, 4, 8}) {
      const Executor executor({.threads = threads});
      Words words(expected.size(), Colouring::none);
      detail::PartsRun(executor, graph.view(), detail::Colours<Width>(words)).run();
      EXPECT_EQ(words, expected) << graph.name << ", threads " << threads;
    }
  }
}

TEST(Together, PartsTakeAtMostOneColourMoreWhereTimingMayDecide) {
  for (const auto& graph : test::test_graphs()) {
    if (graph.vertex_count() == 0) continue;
    const Words expected = by_one_thread(graph);
    const std::uint32_t most = *std::max_element(expected.begin(), expected.end()) + 1;
    for (const int threads : {2, 3, 8}) {
      const Executor executor({.threads = threads, .deterministic = false});
      Words words(expected.size(), Colouring::none);
      detail::PartsRun(executor, graph.view(), detail::Colours<Width>(words)).run();
      EXPECT_TRUE(test::edges_are_properly_coloured(graph, words, Colouring::none)) << graph.name;
      EXPECT_LE(*std::max_element(words.begin(), words.end()), most) << graph.name;
    }
  }
}

TEST(Together, AutomaticIsSerialAtAnyThreadCount) {
  for (const auto& graph : large_graphs()) {
    const Words expected = by_one_thread(graph);
    for (const int threads : {1, 2, 3, 4, 8})
      EXPECT_EQ(colour(Executor({.threads = threads}), graph.view()).colour_of, expected)
          << graph.name << ", threads " << threads;
  }
}

TEST(Together, AutomaticTakesAtMostOneColourMoreWhereTimingMayDecide) {
  for (const auto& graph : large_graphs()) {
    const Words expected = by_one_thread(graph);
    const std::uint32_t count = *std::max_element(expected.begin(), expected.end()) + 1;
    for (const int threads : {1, 2, 3, 8}) {
      const Executor executor({.threads = threads, .deterministic = false});
      for (int run = 0; run < 2; ++run) {
        const Colouring colouring = colour(executor, graph.view());
        EXPECT_TRUE(is_proper(executor, graph.view(), colouring)) << graph.name;
        EXPECT_LE(colouring.count, count + 1) << graph.name << ", threads " << threads;
      }
    }
  }
}

TEST(Together, IsSharedOutByHowTheOrderLiesInTheGraph) {
  const auto kind_of = [](const test::TestGraph& graph, std::uint32_t window = 0) {
    const CsrGraph<> rows = graph.view();
    const detail::Shares shares = detail::OrderOfGraph(Executor({.threads = 2}), rows).shares();
    EXPECT_EQ(shares.window, window) << graph.name;
    return shares.kind;
  };
  using detail::Shares;
  EXPECT_EQ(kind_of(test::random_graph(40'000, 160'000, 1), detail::short_window), Shares::windows);
  EXPECT_EQ(kind_of(test::shuffled(test::mesh_graph(200), 2), detail::short_window),
            Shares::windows);
  EXPECT_EQ(kind_of(box_graph(33), 33 * 33), Shares::windows);
  EXPECT_EQ(kind_of(curve_graph(8)), Shares::parts);
  EXPECT_EQ(kind_of(test::path_graph(40'000)), Shares::parts);
  EXPECT_EQ(kind_of(test::mesh_graph(600)), Shares::none);               // few neighbours
  EXPECT_EQ(kind_of(box_graph(20)), Shares::none);                       // its planes are small
  EXPECT_EQ(kind_of(test::rmat_graph(16, 1'000'000, 3)), Shares::none);  // has hubs
}

/// Other threads wait for the vertices that the throwing thread leaves uncoloured.
TEST(Together, HandsOnWhatTheGraphThrows) {
  const auto mesh = test::mesh_graph(600);
  const auto shuffled = test::shuffled(mesh, 1);
  const auto curve = curve_graph(8);
  const auto box = box_graph(33);
  for (const auto* graph : {&mesh, &shuffled, &curve, &box}) {
    const CsrGraph<> rows = graph->view();
    const std::uint32_t bad = graph->vertex_count() / 2 + 77;
    const auto throwing = CallbackGraph(rows.vertex_count(), [&](std::uint32_t v, auto&& visit) {
      if (v == bad) throw std::domain_error("a bad vertex");
      rows.for_each_neighbour(v, visit);
    });
    for (const int threads : {1, 2, 8})
      EXPECT_THROW(colour(Executor({.threads = threads}), throwing), std::domain_error);
  }
}

}  // namespace
}  // namespace ductile::runtime::together_test
