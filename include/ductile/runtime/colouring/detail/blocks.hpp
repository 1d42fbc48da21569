/// @file
/// How the deterministic parallel colourings go over a graph's blocks (block_layout.hpp): of every
/// row one block is coloured in a step, each by first-fit in order. What is coloured in one step
/// does not see each other. Pairs of neighbours among it are noted; where both have got the same
/// colour, one of them is coloured anew at the end.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/colouring/detail/compiled_graphs.hpp"
#include "ductile/runtime/detail/block_layout.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

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
