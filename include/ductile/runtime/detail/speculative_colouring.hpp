/// @file
/// Parallel colourings that speculate: every vertex takes the least colour it sees free, without
/// waiting for anybody; neighbours that did so at the same moment may clash, and one of them is
/// coloured again. Rounds go on until there is no clash. The colours depend on timing; a team of
/// one has no clashes to look for and gives serial first-fit's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

constexpr LoopOptions speculative_loop{.grain = 256, .serial_below = 1024};

/// A neighbour of lower id has v's colour; of two that clash, the higher id gives way.
template <class Word, Graph G>
bool clashes(const G& graph, std::uint32_t v, const Colours<Word>& colours) {
  const Word own = colours[v];
  bool clash = false;
  graph.for_each_neighbour(v, [&](std::uint32_t u) { clash |= (u < v) & (colours[u] == own); });
  return clash;
}

/// Colours vertices without regard to who else does.
template <class Word, Graph G>
void colour_freely(const Executor& executor, const G& graph, VertexSet vertices,
                   Colours<Word> colours) {
  parallel_for(
      executor, vertices.count,
      [&](std::size_t i) { colours.set(vertices[i], least_free(graph, vertices[i], colours)); },
      speculative_loop);
}

/// The scheme of Catalyurek et al.: colour, barrier, find the clashes, barrier.
struct TwoPhase {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    if (executor.threads() == 1) return Serial::run(executor, graph, vertices, colours);
    Worklist<std::uint32_t> clashing(executor, {.order = WorkOrder::arrival});
    std::vector<std::uint32_t> list;
    while (vertices.count > 0) {
      colour_freely(executor, graph, vertices, colours);
      parallel_for(
          executor, vertices.count,
          [&](std::size_t i) {
            if (clashes(graph, vertices[i], colours)) clashing.append(vertices[i]);
          },
          speculative_loop);
      clashing.collect();
      list = clashing.take();
      vertices = {list.size(), list.data()};
    }
  }
};

/// The scheme of Rokos et al.: who finds a clash recolours at once and is looked at again in the
/// next round; a barrier separates rounds, none is within.
struct DetectAgain {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    if (executor.threads() == 1) return Serial::run(executor, graph, vertices, colours);
    colour_freely(executor, graph, vertices, colours);
    Worklist<std::uint32_t> recoloured(executor, {.order = WorkOrder::arrival});
    std::vector<std::uint32_t> list;
    while (vertices.count > 0) {
      parallel_for(
          executor, vertices.count,
          [&](std::size_t i) {
            const std::uint32_t v = vertices[i];
            if (!clashes(graph, v, colours)) return;
            colours.set(v, least_free(graph, v, colours));
            recoloured.append(v);
          },
          speculative_loop);
      recoloured.collect();
      list = recoloured.take();
      vertices = {list.size(), list.data()};
    }
  }
};

}  // namespace ductile::runtime::detail
