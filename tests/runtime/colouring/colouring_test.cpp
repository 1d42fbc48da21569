#include "ductile/runtime/colouring/colouring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "graphs.hpp"

namespace ductile::runtime::colouring_test {
namespace {

constexpr ColouringMethod methods[] = {ColouringMethod::automatic, ColouringMethod::serial,
                                       ColouringMethod::by_priority, ColouringMethod::detect_again,
                                       ColouringMethod::two_phase};

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
         {ColouringMethod::automatic, ColouringMethod::serial, ColouringMethod::by_priority}) {
      const Colouring first = colour(Executor({.threads = 1}), graph.view(), method);
      for (int threads : {2, 3, 4, 8})
        EXPECT_EQ(colour(Executor({.threads = threads}), graph.view(), method).colour_of,
                  first.colour_of)
            << graph.name << ", threads " << threads;
    }
}

TEST(Colouring, LetsNeighboursBeRepeatedOnOneSideOnly) {
  // A ring with chords; even vertices visit each neighbour three times, odd ones once.
  const std::uint32_t n = 4000;
  const auto graph = CallbackGraph(n, [](std::uint32_t v, auto&& visit) {
    for (int repetition = 0; repetition < (v % 2 == 0 ? 3 : 1); ++repetition)
      for (const std::uint32_t step : {1U, 7U, 100U}) {
        visit((v + step) % n);
        visit((v + n - step) % n);
      }
  });
  for (const ColouringMethod method : methods)
    for (int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      Colouring colouring = colour(executor, graph, method);
      EXPECT_TRUE(is_proper(executor, graph, colouring)) << static_cast<int>(method);
      EXPECT_LE(colouring.count, 7U);
      std::vector<std::uint32_t> some;
      for (std::uint32_t v = 0; v < n; v += 20) some.push_back(v), some.push_back(v + 1);
      recolour(executor, graph, some, colouring);
      EXPECT_TRUE(is_proper(executor, graph, colouring)) << static_cast<int>(method);
    }
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

/// All vertices, ascending.
std::vector<std::uint32_t> vertices_of(const test::TestGraph& graph) {
  std::vector<std::uint32_t> order(graph.vertex_count());
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

/// First-fit, implemented in the plainest way.
std::vector<std::uint32_t> first_fit_in(const std::vector<std::uint32_t>& order,
                                        const test::TestGraph& graph) {
  std::vector<std::uint32_t> colour_of(order.size(), Colouring::none);
  for (const std::uint32_t v : order) {
    std::vector<bool> taken(order.size() + 1);
    graph.view().for_each_neighbour(v, [&](std::uint32_t u) {
      if (colour_of[u] != Colouring::none) taken[colour_of[u]] = true;
    });
    colour_of[v] =
        static_cast<std::uint32_t>(std::find(taken.begin(), taken.end(), false) - taken.begin());
  }
  return colour_of;
}

/// The graphs have rows of no, one, few and many neighbours, even and odd numbers of them. In
/// cliques of consecutive ids the colours of a vertex grow one by one beyond the limit of each
/// width.
TEST(Colouring, SerialIsFirstFitInOrder) {
  auto graphs = test::test_graphs();
  graphs.push_back(test::make_graph("no edges", 300, {}));
  for (const std::uint32_t clique : {60U, 65U, 130U, 300U})
    graphs.push_back(test::clique_graph(clique, clique));
  for (const auto& graph : graphs) {
    const auto expected = first_fit_in(vertices_of(graph), graph);
    const Executor executor({.threads = 1});
    EXPECT_EQ(colour(executor, graph.view(), ColouringMethod::serial).colour_of, expected)
        << graph.name;
    const auto called_back = CallbackGraph(
        graph.view().vertex_count(),
        [&graph](std::uint32_t v, auto&& visit) { graph.view().for_each_neighbour(v, visit); });
    EXPECT_EQ(colour(executor, called_back, ColouringMethod::serial).colour_of, expected)
        << graph.name;
  }
}

/// Serial first-fit in the order of the hashed priority.
std::vector<std::uint32_t> in_order_of_priority(const test::TestGraph& graph) {
  std::vector<std::uint32_t> order = vertices_of(graph);
  std::sort(order.begin(), order.end(),
            [](std::uint32_t u, std::uint32_t v) { return mix32(u) < mix32(v); });
  return first_fit_in(order, graph);
}

TEST(Colouring, ByPriorityIsFirstFitInItsOrder) {
  for (const auto& graph : {test::rmat_graph(9, 6000, 1), test::random_graph(700, 3000, 2),
                            test::star_graph(800), test::clique_graph(900, 90)})
    for (int threads : {1, 3})
      EXPECT_EQ(colour(Executor({.threads = threads}), graph.view(), ColouringMethod::by_priority)
                    .colour_of,
                in_order_of_priority(graph))
          << graph.name;
}

/// Cliques of sizes just within and just beyond the limits of words of each width, on few vertices
/// and on enough for marks.
TEST(Colouring, TakesAsManyColoursAsAreNeeded) {
  for (const std::uint32_t clique :
       {30U, 31U, 47U, 61U, 62U, 63U, 64U, 222U, 223U, 239U, 253U, 254U, 255U, 1100U})
    for (const std::uint32_t vertices : {5 * clique, 9900U}) {
      const auto graph = test::make_graph("clique and lone vertices", vertices,
                                          test::clique_edges(vertices / clique, clique));
      const int threads = clique < 1000 ? 4 : 2;
      const Executor executor({.threads = threads});
      for (const ColouringMethod method : methods) {
        const Colouring colouring = colour(executor, graph.view(), method);
        EXPECT_EQ(colouring.count, clique) << static_cast<int>(method);
        EXPECT_TRUE(is_proper(executor, graph.view(), colouring)) << clique;
      }
    }
}

/// Windows that are coloured at the same time share many edges here; 40 threads share marks.
TEST(Colouring, FindsAllClashesOfSpeculation) {
  for (const auto& graph : {test::mesh_graph(300), test::shuffled(test::mesh_graph(300), 7),
                            test::random_graph(20000, 400000, 8), test::rmat_graph(14, 200000, 9),
                            test::rmat_graph(12, 400000, 15)})
    for (const ColouringMethod method : {ColouringMethod::detect_again, ColouringMethod::two_phase})
      for (int threads : {2, 3, 4, 8, 40}) {
        const Executor executor({.threads = threads});
        for (int run = 0; run < 2; ++run)
          EXPECT_TRUE(is_proper(executor, graph.view(), colour(executor, graph.view(), method)))
              << graph.name << ", threads " << threads;
      }
}

/// Two threads begin in the same clique, each with its half of the vertices, and wait for each
/// other briefly, so that their first colours clash.
TEST(Colouring, TakesNoMoreColoursWhereVerticesAreTheirOwnNeighbours) {
  const std::uint32_t clique = 50, cliques = 200;
  std::array<std::atomic<bool>, 2> has_begun;
  const auto graph = CallbackGraph(clique * cliques, [&](std::uint32_t v, auto&& visit) {
    const std::uint32_t half = clique * cliques / 2;
    if (v % half == 0) {
      has_begun[v / half] = true;
      for (int turn = 0; turn < 100000 && !has_begun[1 - v / half]; ++turn)
        std::this_thread::yield();
    }
    for (std::uint32_t u = v % cliques; u < clique * cliques; u += cliques) visit(u);
  });
  const Executor executor({.threads = 2});
  for (const ColouringMethod method : {ColouringMethod::detect_again, ColouringMethod::two_phase})
    for (int run = 0; run < 5; ++run) {
      for (auto& begun : has_begun) begun = false;
      EXPECT_EQ(colour(executor, graph, method).count, clique) << static_cast<int>(method);
    }
}

/// The second graph has too many colours for short words, and vertices with many neighbours.
TEST(Colouring, OfACallbackIsThatOfItsRows) {
  for (const auto& graph :
       {test::random_graph(5000, 30000, 10), test::rmat_graph(12, 200000, 14)}) {
    const CsrGraph<> rows = graph.view();
    const auto callback = CallbackGraph(rows.vertex_count(), [&](std::uint32_t v, auto&& visit) {
      rows.for_each_neighbour(v, visit);
    });
    const Executor executor({.threads = 2});
    for (const ColouringMethod method : {ColouringMethod::serial, ColouringMethod::by_priority})
      EXPECT_EQ(colour(executor, callback, method).colour_of,
                colour(executor, rows, method).colour_of)
          << graph.name;
  }
}

/// The vertices of a graph whose hash leaves a remainder below `share` of 64.
std::vector<std::uint32_t> some_vertices(const test::TestGraph& graph, std::uint32_t share) {
  std::vector<std::uint32_t> some;
  for (std::uint32_t v = 0; v + 1 < graph.offset.size(); ++v)
    if (mix32(v) % 64 < share) some.push_back(v);
  return some;
}

/// A share of 1 of 64 is few: those vertices are recoloured serially, or by priority in the largest
/// graph.
TEST(Recolour, KeepsTheOthersAndIsTheSameAtAnyThreadCount) {
  std::vector<test::TestGraph> graphs = test::test_graphs();
  graphs.push_back(test::mesh_graph(260));
  for (const auto& graph : graphs)
    for (std::uint32_t share : {1U, 4U, 48U}) {
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
      const auto some = some_vertices(graph, 36);
      Colouring part{std::vector<std::uint32_t>(graph.view().vertex_count(), Colouring::none), 0};
      recolour(Executor({.threads = threads}), graph.view(), some, part);
      EXPECT_TRUE(test::edges_are_properly_coloured(graph, part.colour_of, Colouring::none));
      std::size_t coloured = 0;
      for (const std::uint32_t c : part.colour_of) coloured += c < part.count;
      EXPECT_EQ(coloured, some.size());
    }
}

template <class Width>
void expect_to_fill_what_is_asked_for() {
  using Word = typename Width::Word;
  constexpr std::size_t n = 40;
  const auto most = static_cast<Word>(Width::most);
  for (std::size_t begin = 0; begin <= n; ++begin)
    for (std::size_t end = begin; end <= n; ++end) {
      std::vector<Word> words(n, 1), expected = words;
      detail::Colours<Width>(words).fill(begin, end, most);
      for (std::size_t i = begin; i < end; ++i) expected[i] = most;
      ASSERT_EQ(words, expected) << begin << " to " << end;
    }
}

TEST(Colours, FillWhatIsAskedFor) {
  expect_to_fill_what_is_asked_for<detail::OneByte<>>();
  expect_to_fill_what_is_asked_for<detail::FourBytes<>>();
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
}  // namespace ductile::runtime::colouring_test
