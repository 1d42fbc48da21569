/// @file
/// FacetKey: identifies a facet among those with the same lowest corner; and a hash table for them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

struct FacetKey {
  std::uint64_t others;  ///< its other corners, ascending
  bool odd;              ///< is their order of odd parity? It differs between the two sides
};

/// Sorts the corners without branches, because their order is random.
template <int Dim>
FacetKey key_of(Facet<Dim> corners) {
  unsigned odd = 0;
  const auto order = [&](std::size_t a, std::size_t b) {
    const VertexId first = corners[a], second = corners[b];
    odd ^= static_cast<unsigned>(first > second);
    corners[a] = std::min(first, second);
    corners[b] = std::max(first, second);
  };
  order(0, 1);
  if constexpr (Dim == 3) {
    order(1, 2);
    order(0, 1);
  }
  if constexpr (Dim == 2) return {corners[1], odd != 0};
  return {std::uint64_t{corners[1]} << 32U | corners[Dim - 1], odd != 0};
}

/// Number of slots of a table for so many facets.
inline std::size_t facet_table_size(std::size_t facets) { return std::bit_ceil(2 * facets + 2); }

/// The slot of a facet, or the free one where it belongs. The table's size is facet_table_size() of
/// at least the number of facets.
template <class Place>
Place& facet_place(std::span<Place> table, std::uint64_t others, auto&& is_free) {
  const auto shift = static_cast<unsigned>(64 - std::countr_zero(table.size()));
  std::size_t at = others * 0x9e3779b97f4a7c15U >> shift;
  while (!is_free(table[at]) && table[at].others != others) at = (at + 1) & (table.size() - 1);
  return table[at];
}

}  // namespace ductile::meshadapt
