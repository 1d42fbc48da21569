/// @file
/// Graphs to test with, as lists of sorted edges and compressed rows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"

namespace ductile::runtime::test {

using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct TestGraph : CsrRows {
  std::string name;
  Edges edges;
};

inline TestGraph make_graph(std::string name, std::uint32_t vertices, Edges edges) {
  CsrRows rows = csr_rows(vertices, edges);
  return {std::move(rows), std::move(name), std::move(edges)};
}

/// Loops and repeated edges included.
inline TestGraph random_graph(std::uint32_t vertices, std::size_t edge_count, unsigned seed) {
  std::mt19937 random(seed);
  Edges edges(edge_count);
  for (auto& [u, v] : edges) u = random() % vertices, v = random() % vertices;
  return make_graph("random", vertices, std::move(edges));
}

/// side x side vertices, each square cut by a diagonal, rows one after the other.
inline TestGraph mesh_graph(std::uint32_t side) {
  Edges edges;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t v = y * side + x;
      if (x + 1 < side) edges.emplace_back(v, v + 1);
      if (y + 1 < side) edges.emplace_back(v, v + side);
      if (x + 1 < side && y + 1 < side) edges.emplace_back(v, v + side + 1);
    }
  return make_graph("mesh", side * side, std::move(edges));
}

inline TestGraph star_graph(std::uint32_t vertices) {
  Edges edges;
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (v != vertices / 2) edges.emplace_back(vertices / 2, v);
  return make_graph("star", vertices, std::move(edges));
}

inline TestGraph path_graph(std::uint32_t vertices) {
  Edges edges;
  for (std::uint32_t v = 1; v < vertices; ++v) edges.emplace_back(v - 1, v);
  return make_graph("path", vertices, std::move(edges));
}

/// Every pair among `clique` vertices that are `step` apart.
inline Edges clique_edges(std::uint32_t step, std::uint32_t clique) {
  Edges edges;
  for (std::uint32_t u = 0; u < clique; ++u)
    for (std::uint32_t v = 0; v < u; ++v) edges.emplace_back(u * step, v * step);
  return edges;
}

/// A path, and every pair among `clique` vertices spread over it: needs `clique` colours.
inline TestGraph clique_graph(std::uint32_t vertices, std::uint32_t clique) {
  Edges edges = path_graph(vertices).edges;
  const Edges more = clique_edges(vertices / clique, clique);
  edges.insert(edges.end(), more.begin(), more.end());
  return make_graph("clique", vertices, std::move(edges));
}

/// Skewed degrees: each bit of an edge's ends falls into a quadrant by (0.57, 0.19, 0.19, 0.05).
inline TestGraph rmat_graph(unsigned scale, std::size_t edge_count, unsigned seed) {
  std::mt19937 random(seed);
  std::discrete_distribution<unsigned> quadrant{0.57, 0.19, 0.19, 0.05};
  Edges edges(edge_count);
  for (auto& [u, v] : edges)
    for (unsigned bit = 0; bit < scale; ++bit) {
      const unsigned q = quadrant(random);
      u = 2 * u + q / 2;
      v = 2 * v + q % 2;
    }
  return make_graph("rmat", 1U << scale, std::move(edges));
}

/// The same graph with its vertices renamed at random.
inline TestGraph shuffled(const TestGraph& graph, unsigned seed) {
  std::vector<std::uint32_t> name(graph.offset.size() - 1);
  std::iota(name.begin(), name.end(), 0U);
  std::shuffle(name.begin(), name.end(), std::mt19937(seed));
  Edges edges = graph.edges;
  for (auto& [u, v] : edges) u = name[u], v = name[v];
  return make_graph("shuffled " + graph.name, static_cast<std::uint32_t>(name.size()),
                    std::move(edges));
}

inline std::vector<TestGraph> test_graphs() {
  std::vector<TestGraph> graphs{make_graph("empty", 0, {}),
                                make_graph("lone vertices", 5000, {}),
                                random_graph(300, 900, 1),
                                random_graph(10000, 40000, 2),
                                mesh_graph(110),
                                star_graph(6000),
                                path_graph(9000),
                                clique_graph(6000, 300),
                                rmat_graph(13, 60000, 3)};
  graphs.push_back(shuffled(graphs[4], 4));
  graphs.push_back(shuffled(graphs[6], 5));
  return graphs;
}

/// No edge, loops aside, joins vertices of one colour; `none` marks vertices without.
inline bool edges_are_properly_coloured(const TestGraph& graph,
                                        const std::vector<std::uint32_t>& colour_of,
                                        std::uint32_t none) {
  return std::all_of(graph.edges.begin(), graph.edges.end(), [&](const auto& edge) {
    return edge.first == edge.second || colour_of[edge.first] == none ||
           colour_of[edge.first] != colour_of[edge.second];
  });
}

}  // namespace ductile::runtime::test
