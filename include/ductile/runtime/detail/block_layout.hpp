/// @file
/// BlockLayout: how numbers are cut into blocks for deterministic loops, of which many blocks far
/// apart have their turn in one step: for colourings, and for items that run in tiles.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ductile::runtime::detail {

/// Number v is in block v >> block_bits; 2^step_bits blocks make a row, whose turns are in
/// different steps, in an order that changes from row to row: where the bits of ids have a meaning,
/// equal low bits would gather related blocks in one step.
struct BlockLayout {
  unsigned block_bits, step_bits;

  std::uint32_t step_count() const { return 1U << step_bits; }
  std::size_t block_size() const { return std::size_t{1} << block_bits; }
  std::size_t row_count(std::size_t count) const {
    const unsigned bits = block_bits + step_bits;
    return (count + (std::size_t{1} << bits) - 1) >> bits;
  }
  /// The block of this row that has its turn in this step. A block's step is its number in the
  /// row, exclusive-or the row.
  std::size_t block_of(std::size_t row, std::size_t step) const {
    return (row << step_bits) + ((step ^ row) & (step_count() - 1));
  }
  std::uint32_t row_of(std::uint32_t v) const { return v >> (block_bits + step_bits); }
  std::uint32_t step_of(std::uint32_t v) const {
    return ((v >> block_bits) ^ row_of(v)) & (step_count() - 1);
  }
  bool same_block(std::uint32_t u, std::uint32_t v) const { return (u ^ v) >> block_bits == 0; }
};

/// The rank of a block of items that run one after the other, by its step. Blocks next to each
/// other mostly have neighbours in common. If their ranks followed each other, all blocks of a row
/// would wait in a chain, so their ranks are far apart.
inline std::uint8_t rank_of_block(const BlockLayout& layout, std::size_t block) {
  const auto first = static_cast<std::uint32_t>(block << layout.block_bits);
  return static_cast<std::uint8_t>(7 * layout.step_of(first) & (layout.step_count() - 1));
}

}  // namespace ductile::runtime::detail
