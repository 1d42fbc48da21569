/// @file
/// A parallel colouring that does not depend on threads or timing, of many short blocks side by
/// side (blocks.hpp): few steps, so that it suits small graphs and many threads. A block sees the
/// colours of earlier steps and its own: it is not coloured before those of earlier steps that it
/// meets (ranked_blocks.hpp). The ids of two neighbours tell whether they are of one step. Blocks
/// of a step are far apart, so where ids follow the graph there are hardly any such pairs, and else
/// they are few because a step is a small part of all. Repair is by hashed priority, see
/// blocks.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ductile/runtime/detail/blocks.hpp"
#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/detail/ranked_blocks.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// About 256 blocks side by side, slowly more of them from a million vertices up; fewer of few
/// vertices, as short blocks clash more. More steps make fewer clashes, and longer waits.
inline BlockLayout many_rows(std::size_t vertex_count) {
  const int bits = std::bit_width(vertex_count);
  const int step_bits = std::clamp(bits - 13, 3, 5);
  const int width_bits = std::clamp(bits - 7, 4, 8) + std::max(0, bits - 20) / 2;
  const int block_bits = std::max(0, bits - step_bits - width_bits);
  return {static_cast<unsigned>(block_bits), static_cast<unsigned>(step_bits)};
}

/// In different blocks of one step, which do not see each other. A block's step is the
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
    Ranked blocks(executor_, rows << layout_.step_bits,
                  [&](std::size_t block) { return step_of_block(block); });
    blocks.run([&](std::size_t block) { return begin(block); },
               [&](Begun& begun) { return colour(begun); },
               [&](std::size_t block, auto&& visit) { visit_met(block, visit); });
    repair(executor_, as_compiled(graph_), blind_, colours_.words());
  }

  /// The colour of u as v sees it: none if both are of one step.
  Word colour_seen(std::uint32_t u, std::uint32_t v) const {
    return Apart(layout_)(u, v) && is_given(u) ? Colours<Width>::none : colours_[u];
  }

 private:
  /// A block that a thread has begun: positions in vertices_ of those that are not coloured yet.
  struct Begun {
    std::size_t next, end;
    std::uint32_t step;
  };
  using Ranked = RankedBlocks<Begun>;

  std::uint32_t step_of_block(std::size_t block) const {
    return layout_.step_of(static_cast<std::uint32_t>(block << layout_.block_bits));
  }

  Begun begin(std::size_t block) const {
    const auto [begin, end] = vertices_in(block);
    return {begin, end, step_of_block(block)};
  }

  /// Colours a block until it is done, or another has to come before: returns which, or none.
  std::size_t colour(Begun& begun) {
    // Copies, which the compiler keeps in registers across the calls in the loop.
    const auto& rows = in_registers(graph_);
    const BlockLayout layout = layout_;
    const Apart apart(layout);
    const Colours<Width> colours = colours_;
    const VertexSet vertices = vertices_;
    const std::uint32_t step = begun.step;
    for (; begun.next < begun.end; ++begun.next) {
      prefetch_after(rows, vertices, begun.next);
      const std::uint32_t v = vertices[begun.next];
      TakenColours<SeenFrom<BlockedRun>> seen;
      unsigned waits = 0;
      rows.for_each_neighbour(v, [&](std::uint32_t u) {
        if (apart(u, v)) [[unlikely]]
          if (note_if_blind(u, v)) return;
        const Word colour = colours[u];
        seen.add(colour);
        waits |= static_cast<unsigned>(colour == Colours<Width>::none) &
                 static_cast<unsigned>(layout.step_of(u) < step);
      });
      if (waits != 0) [[unlikely]]
        if (const std::size_t before = look_again(v, seen); before != Ranked::none) return before;
      colours.set(v, least_free(rows, v, SeenFrom(*this, v), seen));
    }
    return Ranked::none;
  }

  /// Sets what v sees of its neighbours, of which some of earlier steps had no colour; returns the
  /// block of one that is going to have one, or none.
  [[gnu::noinline, gnu::cold]] std::size_t look_again(std::uint32_t v,
                                                      TakenColours<SeenFrom<BlockedRun>>& seen) {
    seen = {};
    std::size_t before = Ranked::none;
    graph_.for_each_neighbour(v, [&](std::uint32_t u) {
      const Word colour = colour_seen(u, v);
      seen.add(colour);
      if (colour == Colours<Width>::none && layout_.step_of(u) < layout_.step_of(v) && is_given(u))
        before = u >> layout_.block_bits;
    });
    return before;
  }

  /// The blocks that the vertices of this one have neighbours in, some of them again and again.
  void visit_met(std::size_t block, auto&& visit) const {
    const auto [begin, end] = vertices_in(block);
    for (std::size_t i = begin; i < end; ++i)
      graph_.for_each_neighbour(vertices_[i], [&](std::uint32_t u) {
        if (is_given(u)) visit(std::size_t{u} >> layout_.block_bits);
      });
  }

  /// Whether u and v, which are apart, both get their colours now, and not only v.
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
