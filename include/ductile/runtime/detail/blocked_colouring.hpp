/// @file
/// A parallel colouring that does not depend on threads or timing.
/// The ids are cut into blocks; every `stride`-th block is coloured in the same step, each by
/// first-fit in order, seeing the colours of earlier steps and its own. A neighbour in another
/// block of the step is not looked at, but noted: after the last step the pairs that turn out to
/// have one colour are repaired. Blocks of a step are far apart, so where ids follow the graph
/// there are hardly any such pairs, and else they are few because a step is a small part of all.
/// Repair is greedy by hashed priority: a vertex waits for its waiting neighbours of higher
/// priority, so its new colour is the same whenever it is found.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

/// How ids are cut: vertex v is in block v >> block_bits, block b in step b mod 2^step_bits.
struct BlockLayout {
  unsigned block_bits, step_bits;

  /// Many vertices: more steps, longer blocks, and more blocks side by side.
  static BlockLayout of(std::size_t vertex_count) {
    const auto bits = static_cast<unsigned>(std::bit_width(vertex_count));
    return bits <= 16 ? BlockLayout{6, 3} : BlockLayout{6 + (bits - 16) * 2 / 3, 5};
  }
  std::size_t block_count(std::size_t vertex_count) const {
    return (vertex_count + (std::size_t{1} << block_bits) - 1) >> block_bits;
  }
  /// In different blocks of one step, which are coloured at the same time.
  bool apart(std::uint32_t u, std::uint32_t v) const {
    const std::uint32_t difference = (u ^ v) >> block_bits;
    return difference != 0 && (difference & ((1U << step_bits) - 1)) == 0;
  }
};

template <class Word, Graph G>
class BlockedRun {
 public:
  BlockedRun(const Executor& executor, const G& graph, VertexSet vertices, Colours<Word> colours)
      : executor_(executor),
        graph_(graph),
        vertices_(vertices),
        colours_(colours),
        layout_(BlockLayout::of(colours.vertex_count())),
        unseen_(executor),
        losers_(executor, {.unique = true}) {}

  void run() {
    const std::size_t blocks = layout_.block_count(colours_.vertex_count());
    const std::size_t stride = std::size_t{1} << layout_.step_bits;
    for (std::size_t step = 0; step < stride && step < blocks; ++step) {
      parallel_for(executor_, (blocks - step + stride - 1) / stride,
                   [&](std::size_t i) { colour_block(step + i * stride); }, {.grain = 1});
    }
    find_losers();
    losers_.collect();
    repair(losers_.take());
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  void colour_block(std::size_t block) {
    const auto [begin, end] = vertices_in(block);
    std::vector<Pair>& unseen = unseen_.mine();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t v = vertices_[i];
      const auto seen = [&](std::uint32_t u) {
        if (!layout_.apart(u, v) || !contains(u)) return true;
        if (u < v) unseen.emplace_back(u, v);  // one of the two notes it
        return false;
      };
      colours_.set(v, least_free(graph_, v, colours_, seen));
    }
  }

  /// The positions in vertices_ of a block's.
  std::pair<std::size_t, std::size_t> vertices_in(std::size_t block) const {
    const std::size_t begin = block << layout_.block_bits;
    const std::size_t end =
        std::min(begin + (std::size_t{1} << layout_.block_bits), colours_.vertex_count());
    if (vertices_.list == nullptr) return {begin, end};
    const std::span list(vertices_.list, vertices_.count);
    const auto position = [&](std::size_t id) {
      return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), id) -
                                      list.begin());
    };
    return {position(begin), position(end)};
  }

  bool contains(std::uint32_t v) const {
    return vertices_.list == nullptr ||
           std::binary_search(vertices_.list, vertices_.list + vertices_.count, v);
  }

  static bool outranks(std::uint32_t u, std::uint32_t v) { return mix32(u) < mix32(v); }

  void find_losers() {
    parallel_for(executor_, unseen_.size(),
                 [&](std::size_t t) {
                   for (const auto& [u, v] : unseen_[t])
                     if (colours_[u] == colours_[v]) losers_.append(outranks(u, v) ? v : u);
                 },
                 {.grain = 1});
  }

  void repair(std::vector<std::uint32_t> vertices) {
    const LoopOptions loop{.grain = 64, .serial_below = 1024};
    parallel_for(
        executor_, vertices.size(),
        [&](std::size_t i) { colours_.set(vertices[i], Colours<Word>::waiting); }, loop);
    Worklist<std::uint32_t> later(executor_, {.order = WorkOrder::arrival});
    while (!vertices.empty()) {
      parallel_for(
          executor_, vertices.size(),
          [&](std::size_t i) {
            if (!recoloured(vertices[i])) later.append(vertices[i]);
          },
          loop);
      later.collect();
      vertices = later.take();
    }
  }

  /// False if v has to wait for a neighbour.
  bool recoloured(std::uint32_t v) {
    bool waits = false;
    graph_.for_each_neighbour(v, [&](std::uint32_t u) {
      waits = waits || (colours_[u] == Colours<Word>::waiting && outranks(u, v));
    });
    if (!waits) colours_.set(v, least_free(graph_, v, colours_));
    return !waits;
  }

  const Executor& executor_;
  const G& graph_;
  VertexSet vertices_;
  Colours<Word> colours_;
  BlockLayout layout_;
  PerThread<std::vector<Pair>> unseen_;  // edges between blocks of one step
  Worklist<std::uint32_t> losers_;
};

struct Blocked {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    BlockedRun<Word, G>(executor, graph, vertices, colours).run();
  }
};

}  // namespace ductile::runtime::detail
