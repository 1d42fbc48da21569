/// @file
/// Graphs for the examples, the same in every run: a random one, whose edges each join two hashed
/// vertices, preferring low ones, so that degrees follow a power law of exponent 3; an RMAT graph,
/// with even more uneven degrees; a square grid; points in a square, joined to close ones; and
/// lists of edges with weights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace example {

using Vertex = std::uint32_t;
using Weight = std::uint32_t;

/// The weight of an edge, from 1 on: a hash of its two ends.
inline Weight weight_of(Vertex a, Vertex b) {
  const std::uint64_t ends = std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  return static_cast<Weight>(ductile::runtime::mix64(ends) >> 32U) | 1U;
}

/// The graph of arcs, (from, to) in the two halves of a word, each with its reverse; drops
/// repetitions and loops.
inline ductile::runtime::CsrRows graph_of_arcs(const ductile::runtime::Executor& executor,
                                               std::size_t vertex_count,
                                               std::vector<std::uint64_t> arcs) {
  namespace runtime = ductile::runtime;
  std::erase_if(arcs, [](std::uint64_t arc) { return arc >> 32U == (arc & 0xffffffffU); });
  runtime::parallel_sort(executor, std::span(arcs));
  arcs.resize(runtime::parallel_unique(executor, std::span(arcs)));

  runtime::CsrRows graph{std::vector<std::uint32_t>(vertex_count + 1),
                         std::vector<std::uint32_t>(arcs.size())};
  runtime::parallel_for(executor, vertex_count + 1, [&](std::size_t v) {
    const auto begin = std::lower_bound(arcs.begin(), arcs.end(), std::uint64_t{v} << 32U);
    graph.offset[v] = static_cast<std::uint32_t>(begin - arcs.begin());
  });
  runtime::parallel_for(executor, arcs.size(), [&](std::size_t i) {
    graph.neighbour[i] = static_cast<std::uint32_t>(arcs[i]);
  });
  return graph;
}

/// A graph of `edge_count` edges, or a few less; ends_of(e) is a pair of vertices.
template <class EndsOf>
ductile::runtime::CsrRows graph_of_edges(const ductile::runtime::Executor& executor,
                                         std::size_t vertex_count, std::size_t edge_count,
                                         EndsOf&& ends_of) {
  std::vector<std::uint64_t> arcs(2 * edge_count);
  ductile::runtime::parallel_for(executor, edge_count, [&](std::size_t e) {
    const auto [a, b] = ends_of(e);
    arcs[2 * e] = std::uint64_t{a} << 32U | b;
    arcs[2 * e + 1] = std::uint64_t{b} << 32U | a;
  });
  return graph_of_arcs(executor, vertex_count, std::move(arcs));
}

/// A number from 0 to 1, less than 1.
inline double random_share(std::uint64_t seed) {
  return static_cast<double>(ductile::runtime::mix64(seed) >> 11U) * 0x1p-53;
}

/// A random graph with almost `edge_count` edges.
inline ductile::runtime::CsrRows random_graph(const ductile::runtime::Executor& executor,
                                              std::size_t vertex_count, std::size_t edge_count) {
  const auto vertex = [&](std::uint64_t seed) {
    const double share = random_share(seed);
    return static_cast<Vertex>(share * share * static_cast<double>(vertex_count));
  };
  return graph_of_edges(executor, vertex_count, edge_count, [&](std::size_t e) {
    return std::pair(vertex(2 * e + 1), vertex(2 * e + 2));
  });
}

/// A bijection of the integers below 2^bits; ignores higher bits of x. bits is at most 32.
constexpr std::uint32_t mix_bits(std::uint32_t x, unsigned bits) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1);
  const unsigned half = (bits + 1) / 2;
  x &= mask;
  x ^= x >> half;
  x = (x * 0x7feb352dU) & mask;
  x ^= x >> half;
  x = (x * 0x846ca68bU) & mask;
  return x ^ x >> half;
}

/// An RMAT graph (Chakrabarti, Zhan & Faloutsos, SDM 2004) of 2^scale vertices with almost
/// `edge_count` edges: for each bit of its two ends an edge goes into a quarter of the matrix, by
/// chances of 0.57, 0.19, 0.19 and 0.05. Vertices are numbered at random.
inline ductile::runtime::CsrRows rmat_graph(const ductile::runtime::Executor& executor,
                                            unsigned scale, std::size_t edge_count) {
  return graph_of_edges(executor, std::size_t{1} << scale, edge_count, [&](std::size_t e) {
    Vertex a = 0, b = 0;
    for (unsigned bit = 0; bit < scale; ++bit) {
      const double share = random_share(e * scale + bit + 1);
      a = 2 * a + (share >= 0.76 ? 1 : 0);
      b = 2 * b + ((share >= 0.57 && share < 0.76) || share >= 0.95 ? 1 : 0);
    }
    return std::pair(mix_bits(a, scale), mix_bits(b, scale));
  });
}

/// A square grid of about `vertex_count`.
inline ductile::runtime::CsrRows grid_graph(std::size_t vertex_count) {
  const auto width = static_cast<Vertex>(std::sqrt(static_cast<double>(vertex_count)));
  ductile::runtime::CsrRows graph{{0}, {}};
  for (Vertex v = 0; v < width * width; ++v) {
    if (v >= width) graph.neighbour.push_back(v - width);
    if (v % width > 0) graph.neighbour.push_back(v - 1);
    if (v % width < width - 1) graph.neighbour.push_back(v + 1);
    if (v < width * (width - 1)) graph.neighbour.push_back(v + width);
    graph.offset.push_back(static_cast<std::uint32_t>(graph.neighbour.size()));
  }
  return graph;
}

/// A graph with weights of its arcs, the same in both directions.
struct WeightedGraph {
  ductile::runtime::CsrRows rows;
  std::vector<Weight> weight_of;  // [arc], numbered as the neighbours
};

constexpr Weight most_weight = 1U << 16U;

/// Weights by hashing, from 1 to most_weight.
inline WeightedGraph with_random_weights(ductile::runtime::CsrRows rows) {
  WeightedGraph graph{std::move(rows), {}};
  graph.weight_of.reserve(graph.rows.neighbour.size());
  for (Vertex a = 0; a < graph.rows.vertex_count(); ++a)
    for (const Vertex b : graph.rows.view().row(a))
      graph.weight_of.push_back(1 + (weight_of(a, b) >> 1U) % most_weight);
  return graph;
}

/// Random points in the unit square, numbered by rows of square cells. Each is joined to the points
/// within some radius, about 12. The weight of an edge is its length, most_weight for the radius.
inline WeightedGraph geometric_graph(std::size_t vertex_count) {
  constexpr double pi = 3.14159265358979323846;
  const double radius = std::sqrt(12 / (pi * static_cast<double>(vertex_count)));
  const auto width = std::max<std::size_t>(1, static_cast<std::size_t>(1 / radius));
  struct Place {
    std::size_t cell;
    double x, y;
  };
  std::vector<Place> places(vertex_count);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const double x = random_share(2 * v + 1), y = random_share(2 * v + 2);
    const auto scale = static_cast<double>(width);
    places[v] = {static_cast<std::size_t>(y * scale) * width + static_cast<std::size_t>(x * scale),
                 x, y};
  }
  std::sort(places.begin(), places.end(), [](const Place& one, const Place& two) {
    return std::pair(one.cell, one.x) < std::pair(two.cell, two.x);
  });
  std::vector<Vertex> first(width * width + 1);  // [cell], its first vertex
  for (const Place& place : places) ++first[place.cell + 1];
  for (std::size_t cell = 0; cell < width * width; ++cell) first[cell + 1] += first[cell];

  WeightedGraph graph{{{0}, {}}, {}};
  for (Vertex v = 0; v < vertex_count; ++v) {
    const std::size_t column = places[v].cell % width, row = places[v].cell / width;
    for (std::size_t y = row - (row > 0); y <= std::min(row + 1, width - 1); ++y) {
      const std::size_t left = column - (column > 0), right = std::min(column + 1, width - 1);
      for (Vertex u = first[y * width + left]; u < first[y * width + right + 1]; ++u) {
        const double length = std::hypot(places[u].x - places[v].x, places[u].y - places[v].y);
        if (u == v || length >= radius) continue;
        graph.rows.neighbour.push_back(u);
        graph.weight_of.push_back(1 + static_cast<Weight>(length / radius * most_weight));
      }
    }
    graph.rows.offset.push_back(static_cast<std::uint32_t>(graph.rows.neighbour.size()));
  }
  return graph;
}

struct Edge {
  Vertex a, b;
};

/// The edges of a graph, sorted by their lower ends.
inline std::vector<Edge> edges_of(ductile::runtime::CsrGraph<> graph) {
  std::vector<Edge> edges;
  edges.reserve(graph.neighbour.size() / 2);
  for (Vertex a = 0; a < graph.vertex_count(); ++a)
    for (const Vertex b : graph.row(a))
      if (a < b) edges.push_back({a, b});
  return edges;
}

/// The same edges in a random order.
inline std::vector<Edge> shuffled(const std::vector<Edge>& edges) {
  std::vector<std::pair<std::uint64_t, Edge>> keyed(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    keyed[e] = {ductile::runtime::mix64(e + 1), edges[e]};
  std::sort(keyed.begin(), keyed.end(),
            [](const auto& one, const auto& two) { return one.first < two.first; });
  std::vector<Edge> result(edges.size());
  std::transform(keyed.begin(), keyed.end(), result.begin(),
                 [](const auto& k) { return k.second; });
  return result;
}

/// The weights of edges, by weight_of(a, b).
inline std::vector<Weight> weights_of(std::span<const Edge> edges) {
  std::vector<Weight> weights(edges.size());
  std::transform(edges.begin(), edges.end(), weights.begin(),
                 [](Edge edge) { return weight_of(edge.a, edge.b); });
  return weights;
}

}  // namespace example
