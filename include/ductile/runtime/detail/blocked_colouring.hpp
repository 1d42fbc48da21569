/// @file
/// A parallel colouring that does not depend on threads or timing.
/// The ids are cut into blocks; every `stride`-th block is coloured in the same step, each by
/// first-fit in order, seeing the colours of earlier steps and its own. A neighbour in another
/// block of the step does not count, but is noted: after the last step the pairs that turn out to
/// have one colour are repaired. Blocks of a step are far apart, so where ids follow the graph
/// there are hardly any such pairs, and else they are few because a step is a small part of all.
/// Repair is by hashed priority, see priority_colouring.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic_mark.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/detail/priority_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// How ids are cut: vertex v is in block v >> block_bits; 2^step_bits blocks in a row are coloured
/// in different steps, in an order that changes from row to row: where the bits of ids have a
/// meaning, equal low bits would gather related blocks in one step.
struct BlockLayout {
  unsigned block_bits, step_bits;

  /// About 256 blocks side by side, slowly more of them from a million vertices up; fewer of few
  /// vertices, as short blocks clash more. More steps make fewer clashes, each costs a launch.
  static BlockLayout of(std::size_t vertex_count) {
    const int bits = std::bit_width(vertex_count);
    const int step_bits = std::clamp(bits - 13, 3, 5);
    const int width_bits = std::clamp(bits - 7, 4, 8) + std::max(0, bits - 20) / 2;
    const int block_bits = std::max(0, bits - step_bits - width_bits);
    return {static_cast<unsigned>(block_bits), static_cast<unsigned>(step_bits)};
  }
  std::uint32_t step_count() const { return 1U << step_bits; }
  /// The block of this row that has its turn in this step. A block's step is its number in the
  /// row, exclusive-or the row.
  std::size_t block_of(std::size_t row, std::size_t step) const {
    return (row << step_bits) + ((step ^ row) & (step_count() - 1));
  }
  std::size_t row_count(std::size_t vertex_count) const {
    return (vertex_count >> (block_bits + step_bits)) + 1;
  }
  /// What apart() needs, made once for many calls.
  struct Apart {
    std::uint32_t step_bits, block_mask, step_mask;

    /// In different blocks of one step, which are coloured at the same time. A block's step is the
    /// exclusive-or of two groups of bits of its ids, so that of two ids decides. Without a branch
    /// for each condition: which one fails is hard to predict in a random order.
    bool operator()(std::uint32_t u, std::uint32_t v) const {
      const std::uint32_t bits = u ^ v;
      return static_cast<unsigned>(((bits ^ (bits >> step_bits)) & step_mask) == 0) &
             static_cast<unsigned>(bits > block_mask);
    }
  };
  Apart apart() const {
    return {step_bits, (1U << block_bits) - 1, (step_count() - 1) << block_bits};
  }
};

/// The colours but those of vertices that get theirs at the same time as v.
template <class Run>
class SeenFrom {
 public:
  using Word = typename Run::Word;
  static constexpr Word most = Run::most;

  SeenFrom(const Run& run, std::uint32_t v) : run_(&run), v_(v) {}
  Word operator[](std::uint32_t u) const { return run_->colour_seen(u, v_); }

 private:
  const Run* run_;
  std::uint32_t v_;
};

template <class Width, Graph G>
class BlockedRun {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;

  BlockedRun(const Executor& executor, const G& graph, VertexSet vertices, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        vertices_(vertices),
        colours_(colours),
        layout_(BlockLayout::of(colours.vertex_count())),
        blind_(executor),
        lost_(colours.vertex_count()) {}

  void run() {
    const std::size_t rows = layout_.row_count(colours_.vertex_count());
    for (std::size_t step = 0; step < layout_.step_count(); ++step)
      parallel_for(executor_, rows,
                   [&](std::size_t row) { colour_block(layout_.block_of(row, step)); },
                   {.grain = 1});
    mark_losers();
    const auto append_if_lost = [&](std::size_t v, auto&& append) {
      if (lost_[v]) append(static_cast<std::uint32_t>(v));
    };
    const auto losers = parallel_collect<std::uint32_t>(executor_, lost_.size(), append_if_lost);
    colour_by_priority(executor_, graph_, losers, colours_, outranks);
  }

  /// The colour of u as v sees it: none if it is coloured at the same time.
  Word colour_seen(std::uint32_t u, std::uint32_t v) const {
    return layout_.apart()(u, v) && is_given(u) ? Colours<Width>::none : colours_[u];
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  void colour_block(std::size_t block) {
    const auto [begin, end] = vertices_in(block);
    // Copies, which the compiler keeps in registers across the calls in the loop.
    const auto& rows = in_registers(graph_);
    const BlockLayout::Apart apart = layout_.apart();
    const Colours<Width> colours = colours_;
    const VertexSet vertices = vertices_;
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_after(rows, vertices, i);
      const std::uint32_t v = vertices[i];
      TakenColours<SeenFrom<BlockedRun>> seen;
      rows.for_each_neighbour(v, [&](std::uint32_t u) {
        if (apart(u, v)) [[unlikely]]
          if (note_if_blind(u, v)) return;
        seen.add(colours[u]);
      });
      colours.set(v, least_free(rows, v, SeenFrom(*this, v), seen));
    }
  }

  /// Whether u and v, which are apart, get their colours at the same time, and not only v.
  /// Not inlined, so as to keep the caller's loop tight.
  [[gnu::noinline, gnu::cold]] bool note_if_blind(std::uint32_t u, std::uint32_t v) {
    if (!is_given(u)) return false;
    if (u < v) blind_.mine().emplace_back(u, v);  // one of the two notes it
    return true;
  }

  /// The positions in vertices_ of a block's.
  std::pair<std::size_t, std::size_t> vertices_in(std::size_t block) const {
    const std::size_t n = colours_.vertex_count();
    const std::size_t begin = std::min(block << layout_.block_bits, n);
    const std::size_t end = std::min((block + 1) << layout_.block_bits, n);
    if (vertices_.list == nullptr) return {begin, end};
    const std::span list(vertices_.list, vertices_.count);
    const auto position = [&](std::size_t id) {
      return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), id) -
                                      list.begin());
    };
    return {position(begin), position(end)};
  }

  bool is_given(std::uint32_t v) const {
    return vertices_.list == nullptr ||
           std::binary_search(vertices_.list, vertices_.list + vertices_.count, v);
  }

  void mark_losers() {
    std::vector<std::span<const Pair>> parts;
    for (std::size_t t = 0; t < blind_.size(); ++t)
      for (std::span<const Pair> left = blind_[t]; !left.empty();) {
        parts.push_back(left.first(std::min<std::size_t>(left.size(), 256)));
        left = left.subspan(parts.back().size());
      }
    parallel_for(executor_, parts.size(),
                 [&](std::size_t p) {
                   for (const auto& [u, v] : parts[p])
                     if (colours_[u] == colours_[v]) atomic_mark(lost_[outranks(u, v) ? v : u]);
                 },
                 {.grain = 1, .serial_below = 4});
  }

  const Executor& executor_;
  const G& graph_;
  VertexSet vertices_;
  Colours<Width> colours_;
  BlockLayout layout_;
  PerThread<std::vector<Pair>> blind_;  // neighbours coloured at the same time
  std::vector<std::uint8_t> lost_;      // [vertex], its colour is also that of one that outranks it
};

struct Blocked {
  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Width> colours) {
    BlockedRun<Width, G>(executor, graph, vertices, colours).run();
  }
};

}  // namespace ductile::runtime::detail
