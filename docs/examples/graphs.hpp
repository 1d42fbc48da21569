/// @file
/// Graphs for the examples, the same in every run: a random one, whose edges join two hashed
/// vertices each, the low ones more often, so that degrees follow a power law of exponent 3; and a
/// square grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/csr_rows.hpp"
#include "ductile/runtime/graph.hpp"
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

/// A random graph with almost `edge_count` edges: repetitions and loops are dropped.
inline ductile::runtime::CsrRows random_graph(const ductile::runtime::Executor& executor,
                                              std::size_t vertex_count, std::size_t edge_count) {
  namespace runtime = ductile::runtime;
  const auto vertex = [&](std::uint64_t seed) -> std::uint64_t {
    const double chance = static_cast<double>(runtime::mix64(seed) >> 11U) * 0x1p-53;
    return static_cast<std::uint64_t>(chance * chance * static_cast<double>(vertex_count));
  };
  // Each edge twice, as (from, to) in the two halves of a word.
  std::vector<std::uint64_t> arcs(2 * edge_count);
  runtime::parallel_for(executor, edge_count, [&](std::size_t e) {
    const std::uint64_t a = vertex(2 * e + 1), b = vertex(2 * e + 2);
    arcs[2 * e] = a << 32U | b;
    arcs[2 * e + 1] = b << 32U | a;
  });
  std::erase_if(arcs, [](std::uint64_t arc) { return arc >> 32U == (arc & 0xffffffffU); });
  runtime::parallel_sort(executor, std::span(arcs));
  arcs.resize(runtime::parallel_unique(executor, std::span(arcs)));

  ductile::runtime::CsrRows graph{std::vector<std::uint32_t>(vertex_count + 1),
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

}  // namespace example
