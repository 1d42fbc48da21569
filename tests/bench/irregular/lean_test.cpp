/// @file
/// Tests of the serial codes that the runtime is compared with, and of their input graphs: each
/// against its definition or against Boost.Graph.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/core_numbers.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>

#include "lean/core_numbers.hpp"
#include "lean/delaunay_flips.hpp"
#include "lean/delaunay_insertion.hpp"
#include "lean/delaunay_refinement.hpp"
#include "lean/independent_set.hpp"
#include "lean/kruskal.hpp"
#include "lean/matching.hpp"
#include "lean/minimum_degree.hpp"
#include "lean/shortest_paths.hpp"
#include "lean/spanning_forest.hpp"
#include "start_meshes.hpp"

namespace {

using namespace example;
namespace runtime = ductile::runtime;

using BoostGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                          boost::property<boost::edge_weight_t, std::uint64_t>>;

/// Pseudo-random numbers; each seed gives another series.
struct Random {
  std::uint64_t seed, count = 0;
  std::uint32_t below(std::size_t bound) {
    return static_cast<std::uint32_t>(runtime::mix64(seed << 32U | ++count) % bound);
  }
};

/// A list of edges that includes loops and repetitions.
struct Edges {
  std::size_t vertex_count;
  std::vector<Edge> edges;
  std::vector<Weight> weights;  // some lists have few different ones, 0 among them

  explicit Edges(std::uint64_t seed) : vertex_count(1 + seed % 60) {
    Random random{seed};
    edges.resize(random.below(3 * vertex_count));
    for (Edge& edge : edges) edge = {random.below(vertex_count), random.below(vertex_count)};
    for (std::size_t e = 0; e < edges.size(); ++e)
      weights.push_back(seed % 2 == 0 ? random.below(5) : 1 + random.below(most_weight));
  }

  /// The graph of the list, without loops and repetitions.
  runtime::CsrRows graph() const {
    return graph_of_edges(runtime::Executor({.threads = 1}), vertex_count, edges.size(),
                          [&](std::size_t e) { return std::pair(edges[e].a, edges[e].b); });
  }
  BoostGraph boost_graph() const {
    BoostGraph graph(vertex_count);
    for (std::size_t e = 0; e < edges.size(); ++e)
      add_edge(edges[e].a, edges[e].b, weights[e], graph);
    return graph;
  }
};

constexpr std::uint64_t seeds = 600;

std::size_t component_count(const BoostGraph& graph) {
  std::vector<std::size_t> component_of(num_vertices(graph));
  return boost::connected_components(
      graph, make_iterator_property_map(component_of.begin(), get(boost::vertex_index, graph)));
}

std::size_t component_count(const Edges& list, const std::vector<std::uint32_t>& chosen) {
  BoostGraph graph(list.vertex_count);
  for (const std::uint32_t e : chosen) add_edge(list.edges[e].a, list.edges[e].b, graph);
  return component_count(graph);
}

TEST(Lean, IndependentSetIsTheFirstInOrder) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const runtime::CsrRows graph = Edges(seed).graph();
    const auto member = lean::independent_set(graph.view());
    for (Vertex v = 0; v < graph.vertex_count(); ++v) {
      bool free = true;
      for (const Vertex other : graph.view().row(v)) free &= other > v || member[other] == 0;
      ASSERT_EQ(member[v] != 0, free) << seed;
    }
  }
}

TEST(Lean, MatchingIsTheFirstInOrder) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Edges list(seed);
    const auto matched = lean::matching(list.vertex_count, list.edges);
    std::set<Vertex> taken;
    for (std::uint32_t e = 0; e < list.edges.size(); ++e) {
      const auto [a, b] = list.edges[e];
      const bool free = a != b && !taken.contains(a) && !taken.contains(b);
      ASSERT_EQ(std::binary_search(matched.begin(), matched.end(), e), free) << seed;
      if (free) taken.insert({a, b});
    }
  }
}

TEST(Lean, ForestsSpanWithoutCycles) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Edges list(seed);
    const std::size_t components = component_count(list.boost_graph());
    for (const auto& forest : {lean::spanning_forest(list.vertex_count, list.edges),
                               lean::kruskal(list.vertex_count, list.edges, list.weights)}) {
      ASSERT_EQ(forest.size(), list.vertex_count - components) << seed;
      ASSERT_EQ(component_count(list, forest), components) << seed;
    }
  }
}

TEST(Lean, SpanningForestIsTheFirstInOrder) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Edges list(seed);
    const auto forest = lean::spanning_forest(list.vertex_count, list.edges);
    const std::vector<Weight> same(list.edges.size());
    ASSERT_EQ(forest, lean::kruskal(list.vertex_count, list.edges, same)) << seed;
  }
}

TEST(Lean, KruskalsForestIsAsLightAsBoosts) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Edges list(seed);
    const BoostGraph graph = list.boost_graph();
    std::vector<BoostGraph::edge_descriptor> tree;
    boost::kruskal_minimum_spanning_tree(graph, std::back_inserter(tree));
    std::vector<std::uint64_t> weights, ours;
    for (const auto& edge : tree) weights.push_back(get(boost::edge_weight, graph, edge));
    for (const std::uint32_t e : lean::kruskal(list.vertex_count, list.edges, list.weights))
      ours.push_back(list.weights[e]);
    ASSERT_EQ(ours, weights) << seed;
  }
}

TEST(Lean, CoreNumbersAreBoosts) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const runtime::CsrRows rows = Edges(seed).graph();
    BoostGraph graph(rows.vertex_count());
    for (const Edge edge : edges_of(rows.view())) add_edge(edge.a, edge.b, graph);
    std::vector<std::uint32_t> core_of(rows.vertex_count());
    boost::core_numbers(
        graph, make_iterator_property_map(core_of.begin(), get(boost::vertex_index, graph)));
    ASSERT_EQ(lean::core_numbers(rows.view()), core_of) << seed;
  }
}

TEST(Lean, ShortestPathsAreBoosts) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Edges list(seed);
    for (Edge& edge : list.edges) edge = {std::min(edge.a, edge.b), std::max(edge.a, edge.b)};
    std::vector<std::pair<Vertex, Vertex>> pairs;
    for (const Edge edge : list.edges) pairs.emplace_back(edge.a, edge.b);
    const runtime::CsrRows rows =
        runtime::csr_rows(static_cast<std::uint32_t>(list.vertex_count), pairs);
    // A repeated edge has its least weight, seen from either end.
    std::vector<Weight> weight_of;
    BoostGraph graph(list.vertex_count);
    for (Vertex a = 0; a < list.vertex_count; ++a)
      for (const Vertex b : rows.view().row(a)) {
        Weight least = std::numeric_limits<Weight>::max();
        for (std::size_t e = 0; e < list.edges.size(); ++e)
          if (list.edges[e].a == std::min(a, b) && list.edges[e].b == std::max(a, b))
            least = std::min(least, list.weights[e]);
        weight_of.push_back(least);
        add_edge(a, b, least, graph);
      }
    std::vector<std::uint64_t> distance_of(list.vertex_count);
    const Vertex source = static_cast<Vertex>(seed % list.vertex_count);
    boost::dijkstra_shortest_paths(
        graph, source,
        boost::distance_map(
            make_iterator_property_map(distance_of.begin(), get(boost::vertex_index, graph)))
            .distance_inf(lean::unreachable));
    const auto ours = lean::shortest_paths(rows.view(), weight_of, source);
    ASSERT_TRUE(std::equal(ours.begin(), ours.end(), distance_of.begin(), distance_of.end()))
        << seed;
  }
}

/// Eliminates vertices one by one; returns the entries of the factor.
std::uint64_t eliminate(const runtime::CsrRows& rows, const lean::Ordering& ordering) {
  std::vector<std::set<Vertex>> beside(rows.vertex_count());
  for (Vertex v = 0; v < rows.vertex_count(); ++v)
    for (const Vertex u : rows.view().row(v)) beside[v].insert(u);
  std::uint64_t fill = 0;
  std::set<Vertex> left;
  for (Vertex v = 0; v < rows.vertex_count(); ++v) left.insert(v);
  for (std::size_t i = 0, step = 0; i < ordering.order.size(); ++i) {
    const Vertex v = ordering.order[i];
    if (step < ordering.steps.size() && ordering.steps[step] == i) {
      ++step;
      // Vertices with the same closed neighbourhood are eliminated together. The degree of v
      // without them, its external degree, is at most the least degree.
      std::size_t least = rows.vertex_count();
      for (const Vertex u : left) least = std::min(least, beside[u].size());
      const std::size_t alike = std::count_if(left.begin(), left.end(), [&](Vertex u) {
        std::set<Vertex> of_u = beside[u], of_v = beside[v];
        of_u.insert(u);
        of_v.insert(v);
        return of_u == of_v;
      });
      EXPECT_LE(beside[v].size() + 1 - alike, least);
    }
    fill += 1 + beside[v].size();
    left.erase(v);
    for (const Vertex u : beside[v]) {
      beside[u].erase(v);
      for (const Vertex w : beside[v])
        if (w != u) beside[u].insert(w);
    }
    beside[v].clear();
  }
  EXPECT_TRUE(left.empty());
  return fill;
}

TEST(Lean, MinimumDegreeTakesTheLeastAndCountsTheFill) {
  std::vector<runtime::CsrRows> graphs;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) graphs.push_back(Edges(seed).graph());
  for (const std::size_t size : {1, 4, 25, 100, 144}) graphs.push_back(grid_graph(size));
  graphs.push_back(geometric_graph(150).rows);
  for (const runtime::CsrRows& graph : graphs) {
    const lean::Ordering ordering = lean::MinimumDegree(graph.view()).run();
    ASSERT_EQ(ordering.order.size(), graph.vertex_count());
    ASSERT_EQ(eliminate(graph, ordering), ordering.fill);
    ASSERT_FALSE(HasFailure()) << graph.vertex_count() << " vertices";
  }
}

TEST(Lean, FlipsEndInADelaunayTriangulation) {
  for (const std::size_t size : {1, 10, 100, 1000, 5000}) {
    Triangulation mesh = rows_of_points(size);
    lean::delaunay_flips(mesh);
    EXPECT_EQ(delaunay_area(mesh), 2 * std::int64_t{square_side} * square_side) << size;
  }
}

TEST(Lean, RefinementLeavesNoBadTriangle) {
  for (const double cells : {0.2, 1.0, 1.5, 4.0}) {
    Triangulation mesh = plate();
    lean::DelaunayRefinement refinement(mesh, cell_side / cells);
    refinement.run();
    EXPECT_EQ(delaunay_area(mesh), 2 * plate_area) << cells;
    for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
      ASSERT_FALSE(refinement.is_bad(t)) << cells;
  }
  for (const std::size_t size : {10, 300, 2000}) {  // for the angles alone
    Triangulation mesh = rows_of_points(size);
    lean::delaunay_flips(mesh);
    lean::DelaunayRefinement refinement(mesh, 1e12);
    refinement.run();
    EXPECT_EQ(delaunay_area(mesh), 2 * std::int64_t{square_side} * square_side) << size;
    for (TriangleId t = 0; t < mesh.corners_of.size(); ++t)
      ASSERT_FALSE(refinement.is_bad(t)) << size;
  }
}

/// Random points of a grid of `steps` steps; few steps give collinear, cocircular and repeated
/// points.
std::vector<Point> points_in_steps(std::uint64_t seed, std::size_t count, std::int32_t steps) {
  Random random{seed};
  const std::int32_t step = square_side / steps, height = std::max(2, steps / 2) * step;
  std::vector<Point> points{{0, 0}, {steps * step, 0}, {steps * step, height}, {0, height}};
  while (points.size() < count + 4)
    points.push_back({static_cast<std::int32_t>(1 + random.below(steps - 1)) * step,
                      static_cast<std::int32_t>(1 + random.below(height / step - 1)) * step});
  return points;
}

TEST(Lean, InsertionGivesADelaunayTriangulationOfAllPoints) {
  for (const std::int32_t steps : {4, 5, 8, 30, 1000, square_side})
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const auto points = points_in_steps(seed, seed * seed, steps);
      const Triangulation mesh = lean::delaunay_insertion(points);
      ASSERT_EQ(delaunay_area(mesh), 2 * std::int64_t{points[2].x} * points[2].y) << seed;
      const std::size_t distinct = std::set(points.begin(), points.end()).size();
      ASSERT_EQ(mesh.corners_of.size(), 2 * distinct - 6) << steps << ' ' << seed;
    }
}

TEST(Lean, HilbertsCurveGoesFromCellToCell) {
  constexpr std::uint32_t bits = 5, side = 1U << bits;
  std::vector<Point> cells(side * side, {-1, -1});
  for (std::int32_t y = 0; y < std::int32_t{side}; ++y)
    for (std::int32_t x = 0; x < std::int32_t{side}; ++x)
      cells[lean::hilbert_place(x, y, bits)] = {x, y};
  for (std::size_t k = 1; k < cells.size(); ++k)
    ASSERT_EQ(squared_length(cells[k - 1], cells[k]), 1) << k;
}

TEST(Lean, WordsAreSortedByTheirUpperHalves) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random{seed};
    std::vector<std::uint64_t> words(seed * 20);
    for (auto& word : words) {
      const std::uint64_t half =
          seed % 2 == 0 ? random.below(4) : random.below(std::size_t{1} << 32U);
      word = half << 32U | random.below(std::size_t{1} << 32U);
    }
    auto expected = words;
    std::stable_sort(expected.begin(), expected.end(),
                     [](std::uint64_t a, std::uint64_t b) { return a >> 32U < b >> 32U; });
    lean::sort_by_upper_half(words);
    ASSERT_EQ(words, expected) << seed;
  }
}

TEST(ExampleGraphs, AreSymmetricWithoutLoopsAndRepetitions) {
  const runtime::Executor executor({.threads = 2});
  const WeightedGraph geometric = geometric_graph(3000);
  const runtime::CsrRows graphs[] = {random_graph(executor, 500, 2000),
                                     rmat_graph(executor, 9, 3000), grid_graph(400), geometric.rows,
                                     Edges(59).graph()};
  for (const runtime::CsrRows& graph : graphs) {
    std::set<std::pair<Vertex, Vertex>> arcs;
    for (Vertex v = 0; v < graph.vertex_count(); ++v)
      for (const Vertex u : graph.view().row(v)) {
        ASSERT_NE(u, v);
        ASSERT_TRUE(arcs.emplace(v, u).second);
      }
    for (const auto& [v, u] : arcs) ASSERT_TRUE(arcs.contains({u, v}));
    ASSERT_EQ(edges_of(graph.view()).size(), arcs.size() / 2);
    ASSERT_EQ(shuffled(edges_of(graph.view())).size(), arcs.size() / 2);
  }
  const double mean_degree = static_cast<double>(geometric.rows.neighbour.size()) / 3000;
  EXPECT_GT(mean_degree, 10);
  EXPECT_LT(mean_degree, 12);
}

TEST(ExampleGraphs, WeighTheSameInBothDirections) {
  for (const WeightedGraph& graph : {geometric_graph(1), geometric_graph(2), geometric_graph(1000),
                                     with_random_weights(grid_graph(900))}) {
    const auto view = graph.rows.view();
    ASSERT_EQ(graph.weight_of.size(), view.neighbour.size());
    for (Vertex v = 0; v < view.vertex_count(); ++v)
      for (std::uint32_t arc = view.offset[v]; arc < view.offset[v + 1]; ++arc) {
        const Vertex u = view.neighbour[arc];
        const auto back = std::find(view.row(u).begin(), view.row(u).end(), v);
        ASSERT_NE(back, view.row(u).end());
        ASSERT_EQ(graph.weight_of[arc], graph.weight_of[&*back - view.neighbour.data()]);
        ASSERT_GE(graph.weight_of[arc], 1U);
        ASSERT_LE(graph.weight_of[arc], most_weight);
      }
  }
}

}  // namespace
