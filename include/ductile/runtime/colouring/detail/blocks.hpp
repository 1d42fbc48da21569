/// @file
/// How the deterministic parallel colourings cut a graph's ids into blocks. A row of blocks is a
/// stretch of ids; of every row one block is coloured in a step, each by first-fit in order. What
/// is coloured in one step does not see each other: pairs of neighbours among it are noted, and who
/// turns out to have lost against its neighbour is coloured anew at the end.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// Vertex v is in block v >> block_bits; 2^step_bits blocks make a row, which are coloured in
/// different steps, in an order that changes from row to row: where the bits of ids have a meaning,
/// equal low bits would gather related blocks in one step.
struct BlockLayout {
  unsigned block_bits, step_bits;

  std::uint32_t step_count() const { return 1U << step_bits; }
  std::size_t block_size() const { return std::size_t{1} << block_bits; }
  std::size_t row_count(std::size_t vertex_count) const {
    const unsigned bits = block_bits + step_bits;
    return (vertex_count + (std::size_t{1} << bits) - 1) >> bits;
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
/// other are mostly neighbours: their ranks are far apart, as all of a row would wait in a chain if
/// one came right after the other.
inline std::uint8_t rank_of_block(const BlockLayout& layout, std::size_t block) {
  const auto first = static_cast<std::uint32_t>(block << layout.block_bits);
  return static_cast<std::uint8_t>(7 * layout.step_of(first) & (layout.step_count() - 1));
}

/// The colours as a run shows them to v: none of those who get theirs at the same time.
template <class Run>
class SeenFrom {
 public:
  using Word = typename Run::Word;
  static constexpr Word most = Run::most;
  static constexpr std::uint32_t marks = Run::marks;

  SeenFrom(const Run& run, std::uint32_t v) : run_(&run), v_(v) {}
  Word operator[](std::uint32_t u) const { return run_->colour_seen(u, v_); }

 private:
  const Run* run_;
  std::uint32_t v_;
};

/// Neighbours that were coloured at the same time, as threads noted them.
using BlindPairs = PerThread<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;

/// Of the pairs that have one colour, those that are outranked get another, by priority. Nobody is
/// being coloured any more, so no words are marks.
template <std::unsigned_integral Word, CompiledGraph G>
void repair(const Executor& executor, const G& graph, const BlindPairs& blind,
            std::span<Word> colour_of);

}  // namespace ductile::runtime::detail
