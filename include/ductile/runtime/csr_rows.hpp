/// @file
/// CsrRows: compressed rows that own their arrays, made from a list of edges.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/graph.hpp"

namespace ductile::runtime {

/// Compressed rows of a symmetric graph; view() shows them as a Graph.
struct CsrRows {
  std::vector<std::uint32_t> offset, neighbour;  ///< [vertex + 1]; [offset.back()]

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(view().vertex_count()); }
  CsrGraph<> view() const { return {offset, neighbour}; }
};

/// Both directions of every edge, of which there are less than 2^31; a vertex's neighbours are in
/// the order of the edges. Loops and repeated edges stay. Throws std::out_of_range for a vertex
/// that is not there, std::bad_alloc. Thread safety: any thread; runs on the caller.
inline CsrRows csr_rows(std::uint32_t vertex_count,
                        std::span<const std::pair<std::uint32_t, std::uint32_t>> edges) {
  CsrRows rows{std::vector<std::uint32_t>(std::size_t{vertex_count} + 1), {}};
  for (const auto& [u, v] : edges) {
    ++rows.offset.at(std::size_t{u} + 1);
    ++rows.offset.at(std::size_t{v} + 1);
  }
  std::partial_sum(rows.offset.begin(), rows.offset.end(), rows.offset.begin());
  rows.neighbour.resize(rows.offset.back());
  std::vector<std::uint32_t> next = rows.offset;
  for (const auto& [u, v] : edges) {
    rows.neighbour[next[u]++] = v;
    rows.neighbour[next[v]++] = u;
  }
  return rows;
}

}  // namespace ductile::runtime
