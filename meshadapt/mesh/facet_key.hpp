/// @file
/// FacetKey: what tells a facet from others of the same lowest corner, and a table to find it in.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt {

struct FacetKey {
  std::uint64_t others;  ///< its corners but the lowest, ascending
  bool odd;              ///< is their order of odd parity? So it is from one side of two
};

/// Sorts the corners without branches, as their order is a matter of chance.
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

/// The places that a table for so many facets is to have.
inline std::size_t facet_table_size(std::size_t facets) { return std::bit_ceil(2 * facets + 2); }

/// Where a table has a facet, or the free place where it would have it. Its size is that of
/// facet_table_size() for so many or more.
template <class Place>
Place& facet_place(std::span<Place> table, std::uint64_t others, auto&& is_free) {
  const auto shift = static_cast<unsigned>(64 - std::countr_zero(table.size()));
  std::size_t at = others * 0x9e3779b97f4a7c15U >> shift;
  while (!is_free(table[at]) && table[at].others != others) at = (at + 1) & (table.size() - 1);
  return table[at];
}

}  // namespace ductile::meshadapt
