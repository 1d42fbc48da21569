#include "ductile/runtime/colouring/detail/fronts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "graphs.hpp"

namespace ductile::runtime::fronts_test {
namespace {

using detail::Front;
using detail::Fronts;
using detail::Window;

/// side^3 vertices in rows; every cube is cut along its main diagonal.
test::TestGraph box_graph(std::uint32_t side) {
  test::Edges edges;
  for (std::uint32_t v = 0; v < side * side * side; ++v)
    for (std::uint32_t step = 1; step < 8; ++step) {
      const std::uint32_t dx = step % 2, dy = step / 2 % 2, dz = step / 4;
      if (v % side + dx < side && v / side % side + dy < side && v / side / side + dz < side)
        edges.emplace_back(v, v + dx + side * (dy + side * dz));
    }
  return test::make_graph("box", side * side * side, std::move(edges));
}

/// Meshes whose rows and planes end at the border between two parts, and meshes where they do not.
std::vector<test::TestGraph> meshes() {
  return {test::mesh_graph(300), test::mesh_graph(301), box_graph(40), box_graph(41)};
}

TEST(Fronts, HaveEveryVertexOnceHoweverWindowsAreTaken) {
  std::vector<test::TestGraph> graphs = test::test_graphs();
  for (test::TestGraph& mesh : meshes()) graphs.push_back(std::move(mesh));
  for (const auto& graph : graphs)
    for (const std::uint32_t count : {1U, 2U, 3U, 4U, 7U}) {
      Fronts fronts(graph.view(), count);
      EXPECT_EQ(fronts.count(), count);
      std::vector<int> times(graph.view().vertex_count());
      const auto visit = [&](const Window& window) {
        for (std::uint32_t i = 0; i < window.size(); ++i) ++times[window[i]];
      };
      for (const Window& seed : fronts.seeds()) visit(seed);
      for (std::size_t f = 0; f < count; ++f) {
        bool first = f % 2 == 0;
        for (auto window = first ? fronts[f].take_first() : fronts[f].take_last(); window;
             window = (first = !first) ? fronts[f].take_first() : fronts[f].take_last())
          visit(*window);
      }
      EXPECT_EQ(std::count(times.begin(), times.end(), 1), std::ssize(times)) << graph.name;
    }
}

/// A graph of `count` vertices without neighbours; vertex_count() is a 32-bit number.
struct Lonely {
  std::uint32_t count;
  std::uint32_t vertex_count() const { return count; }
  void for_each_neighbour(std::uint32_t, auto&&) const {}
};

TEST(Fronts, ShareOutMoreVerticesThanProductsOf32BitsHold) {
  const Lonely graph{1U << 28U};
  Fronts fronts(graph, 16);
  std::uint64_t vertices = 0;
  for (std::size_t f = 0; f < fronts.count(); ++f)
    while (const auto window = fronts[f].take_first()) vertices += window->size();
  EXPECT_EQ(vertices, graph.count);
}

TEST(Fronts, GoUpAndDownFromASeedOfFewVertices) {
  for (const auto& mesh : meshes()) {
    const auto n = static_cast<std::uint32_t>(mesh.view().vertex_count());
    Fronts fronts(mesh.view(), 2);
    ASSERT_EQ(fronts.seeds().size(), 1U);
    const Window seed = fronts.seeds()[0];
    EXPECT_EQ(seed.begin, n / 2);
    EXPECT_LE(seed.size(), n / 16);
    const Window down = fronts[0].take_first().value(), up = fronts[1].take_first().value();
    EXPECT_EQ(down[0] + 1, seed.begin);
    EXPECT_EQ(down[1] + 1, down[0]);
    EXPECT_EQ(up[0], seed.end);
    EXPECT_EQ(up[1], up[0] + 1);
    EXPECT_EQ(fronts[0].take_first().value()[0] + 1, down.begin);
    EXPECT_EQ(fronts[1].take_last().value()[0], n - 1);
  }
}

TEST(Fronts, AllGoUpWhereNeighboursAreFarApart) {
  const auto graph = test::shuffled(test::mesh_graph(300), 5);
  Fronts fronts(graph.view(), 4);
  EXPECT_TRUE(fronts.seeds().empty());
  for (std::uint32_t f = 0; f < 4; ++f) EXPECT_EQ(fronts[f].take_first().value()[0], 90000 / 4 * f);
}

TEST(Fronts, NeedNoMoreColoursThanInOrder) {
  for (const auto& mesh : meshes()) {
    const CsrGraph<> rows = mesh.view();
    std::vector<std::uint8_t> bytes(rows.vertex_count(), 255);
    const detail::Colours<detail::OneByte<>> colours(bytes);
    const auto visit = [&](const Window& window) {
      for (std::uint32_t i = 0; i < window.size(); ++i)
        colours.set(window[i], detail::least_free(rows, window[i], colours));
    };
    Fronts fronts(rows, 2);
    visit(fronts.seeds()[0]);
    for (bool more = true; more;) {
      more = false;
      for (std::size_t f = 0; f < 2; ++f)
        if (const auto window = fronts[f].take_first()) visit(*window), more = true;
    }
    const auto serial = colour(Executor({.threads = 1}), rows, ColouringMethod::serial).count;
    EXPECT_LE(*std::max_element(bytes.begin(), bytes.end()) + 1U, serial) << rows.vertex_count();
  }
}

/// Loops inside another one run on the caller alone, so that nothing depends on timing.
TEST(Fronts, MakeSpeculationAsGoodAsOrderIfNobodyIsLate) {
  for (const auto& mesh : meshes())
    for (const ColouringMethod method :
         {ColouringMethod::detect_again, ColouringMethod::two_phase}) {
      const Executor executor({.threads = 2});
      Colouring colouring;
      parallel_for(executor, 2,
                   [&](std::size_t i) {
                     if (i == 0) colouring = colour(executor, mesh.view(), method);
                   },
                   {.grain = 1});
      EXPECT_TRUE(is_proper(executor, mesh.view(), colouring));
      EXPECT_LE(colouring.count, colour(executor, mesh.view(), ColouringMethod::serial).count);
    }
}

TEST(Fronts, AreHelpedWhereTheyHaveBegunAndMuchIsLeft) {
  Front front({0, 1000}, 100, 4);
  EXPECT_EQ(front.worth_help(), 0U);
  front.take_first();
  EXPECT_EQ(front.worth_help(), 9U);
  while (front.worth_help() > 0) front.take_last();
  EXPECT_EQ(front.take_first().value().begin, 100U);
  EXPECT_EQ(front.take_first().value().begin, 200U);
  EXPECT_EQ(front.take_first().value().begin, 300U);
  EXPECT_FALSE(front.take_first());
  EXPECT_FALSE(front.take_last());
}

TEST(Fronts, SayWhichHasMostLeft) {
  const auto graph = test::shuffled(test::mesh_graph(300), 5);
  Fronts fronts(graph.view(), 3);
  EXPECT_EQ(fronts.slowest(), nullptr);
  for (std::size_t f : {0U, 1U, 1U, 2U, 2U}) fronts[f].take_first();
  EXPECT_EQ(fronts.slowest(), &fronts[0]);
  while (fronts[0].take_last()) {
  }
  EXPECT_NE(fronts.slowest(), &fronts[0]);
}

}  // namespace
}  // namespace ductile::runtime::fronts_test
