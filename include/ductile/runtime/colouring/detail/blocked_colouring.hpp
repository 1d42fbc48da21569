/// @file
/// A parallel colouring that does not depend on threads or timing, of many short blocks side by
/// side (blocks.hpp): few steps, so that it suits small graphs and many threads. A block sees the
/// colours of earlier steps and its own; the ids of two neighbours tell whether they are coloured
/// at the same time. Blocks of a step are far apart, so where ids follow the graph there are hardly
/// any such pairs, and else they are few because a step is a small part of all. Repair is by hashed
/// priority, see blocks.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ductile/runtime/colouring/detail/blocks.hpp"
#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// About 256 blocks side by side, slowly more of them from a million vertices up; fewer of few
/// vertices, as short blocks clash more. More steps make fewer clashes, each costs a launch.
inline BlockLayout many_rows(std::size_t vertex_count) {
  const int bits = std::bit_width(vertex_count);
  const int step_bits = std::clamp(bits - 13, 3, 5);
  const int width_bits = std::clamp(bits - 7, 4, 8) + std::max(0, bits - 20) / 2;
  const int block_bits = std::max(0, bits - step_bits - width_bits);
  return {static_cast<unsigned>(block_bits), static_cast<unsigned>(step_bits)};
}

/// In different blocks of one step, which are coloured at the same time. A block's step is the
/// exclusive-or of two groups of bits of its ids, so that of two ids decides. Without a branch for
/// each condition: which one fails is hard to predict in a random order.
class Apart {
 public:
  explicit Apart(const BlockLayout& layout)
      : step_bits_(layout.step_bits),
        block_mask_((1U << layout.block_bits) - 1),
        step_mask_((layout.step_count() - 1) << layout.block_bits) {}

  bool operator()(std::uint32_t u, std::uint32_t v) const {
    const std::uint32_t bits = u ^ v;
    return static_cast<unsigned>(((bits ^ (bits >> step_bits_)) & step_mask_) == 0) &
           static_cast<unsigned>(bits > block_mask_);
  }

 private:
  std::uint32_t step_bits_, block_mask_, step_mask_;
};

template <class Width, Graph G>
class BlockedRun {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;

  BlockedRun(const Executor& executor, const G& graph, VertexSet vertices, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        vertices_(vertices),
        colours_(colours),
        layout_(many_rows(colours.vertex_count())),
        blind_(executor) {}

  void run() {
    const std::size_t rows = layout_.row_count(colours_.vertex_count());
    for (std::size_t step = 0; step < layout_.step_count(); ++step)
      parallel_for(executor_, rows,
                   [&](std::size_t row) { colour_block(layout_.block_of(row, step)); },
                   {.grain = 1});
    repair(executor_, as_compiled(graph_), blind_, colours_.words());
  }

  /// The colour of u as v sees it: none if it is coloured at the same time.
  Word colour_seen(std::uint32_t u, std::uint32_t v) const {
    return Apart(layout_)(u, v) && is_given(u) ? Colours<Width>::none : colours_[u];
  }

 private:
  void colour_block(std::size_t block) {
    const auto [begin, end] = vertices_in(block);
    // Copies, which the compiler keeps in registers across the calls in the loop.
    const auto& rows = in_registers(graph_);
    const Apart apart(layout_);
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

  const Executor& executor_;
  const G& graph_;
  VertexSet vertices_;
  Colours<Width> colours_;
  BlockLayout layout_;
  BlindPairs blind_;
};

struct Blocked {
  static constexpr std::uint32_t marks = 0;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Width> colours) {
    BlockedRun<Width, G>(executor, graph, vertices, colours).run();
  }
};

}  // namespace ductile::runtime::detail
