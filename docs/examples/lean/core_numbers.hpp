/// @file
/// Core numbers, serially: vertices in buckets by degree; one of the least is taken away, and its
/// neighbours move down a bucket (Batagelj & Zaversnik, arXiv:cs/0310049).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "../graphs.hpp"

namespace lean {

/// [vertex].
inline std::vector<std::uint32_t> core_numbers(ductile::runtime::CsrGraph<> graph) {
  using example::Vertex;
  const auto n = static_cast<Vertex>(graph.vertex_count());
  std::vector<std::uint32_t> degree_of(n);  // [vertex], and in the end its core number
  std::uint32_t most = 0;
  for (Vertex v = 0; v < n; ++v)
    most = std::max(most, degree_of[v] = graph.offset[v + 1] - graph.offset[v]);

  std::vector<std::uint32_t> begin(most + 2);  // [degree], where its bucket begins in `sorted`
  for (const std::uint32_t degree : degree_of) ++begin[degree + 1];
  for (std::uint32_t degree = 0; degree <= most; ++degree) begin[degree + 1] += begin[degree];
  std::vector<Vertex> sorted(n);
  std::vector<std::uint32_t> place_of(n);  // [vertex], in `sorted`
  std::vector<std::uint32_t> next = begin;
  for (Vertex v = 0; v < n; ++v) sorted[place_of[v] = next[degree_of[v]]++] = v;

  for (std::uint32_t i = 0; i < n; ++i) {
    const Vertex vertex = sorted[i];
    for (const Vertex other : graph.row(vertex)) {
      if (degree_of[other] <= degree_of[vertex]) continue;
      // The first of its bucket and it change places, and the bucket begins after it.
      const std::uint32_t from = place_of[other], to = begin[degree_of[other]]++;
      std::swap(sorted[from], sorted[to]);
      place_of[sorted[from]] = from;
      place_of[other] = to;
      --degree_of[other];
    }
  }
  return degree_of;
}

}  // namespace lean
