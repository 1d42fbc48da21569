/// @file
/// First-fit in order of hashed priority, on many threads (Jones and Plassmann, SIAM J. Sci.
/// Comput. 14, 1993): a vertex waits for its uncoloured neighbours of higher priority and ignores
/// those of lower, which wait for it. So its colour is the same whenever it is found, and all may
/// go on without regard to rounds; a round only collects who still waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

inline bool outranks(std::uint32_t u, std::uint32_t v) { return mix32(u) < mix32(v); }

/// Colours v unless it has to wait for a neighbour; false then.
template <class Word, Graph G>
bool colour_in_turn(const G& graph, std::uint32_t v, const Colours<Word>& colours) {
  bool waits = false;
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    waits = waits || (colours[u] == Colours<Word>::waiting && outranks(u, v));
  });
  if (!waits) colours.set(v, least_free(graph, v, colours));
  return !waits;
}

/// Takes the colours of `vertices` away and gives them new ones.
template <class Word, Graph G>
void colour_by_priority(const Executor& executor, const G& graph,
                        std::vector<std::uint32_t> vertices, Colours<Word> colours) {
  const LoopOptions loop{.grain = 64, .serial_below = 1024};
  parallel_for(
      executor, vertices.size(),
      [&](std::size_t i) { colours.set(vertices[i], Colours<Word>::waiting); }, loop);
  Worklist<std::uint32_t> later(executor, {.order = WorkOrder::arrival});
  while (!vertices.empty()) {
    parallel_for(
        executor, vertices.size(),
        [&](std::size_t i) {
          if (!colour_in_turn(graph, vertices[i], colours)) later.append(vertices[i]);
        },
        loop);
    later.collect();
    vertices = later.take();
  }
}

struct ByPriority {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    std::vector<std::uint32_t> all(vertices.count);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = vertices[i];
    colour_by_priority(executor, graph, std::move(all), colours);
  }
};

}  // namespace ductile::runtime::detail
