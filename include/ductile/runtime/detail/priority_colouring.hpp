/// @file
/// First-fit in order of priority, on many threads (Jones and Plassmann, SIAM J. Sci. Comput. 14,
/// 1993): a vertex waits for its uncoloured neighbours of higher priority and ignores those of
/// lower, which wait for it. So its colour is the same whenever it is found, and all may go on
/// without regard to rounds; a round only collects who still waits.
/// The result is that of serial first-fit in descending order of priority.
#pragma once

#include <bit>
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

/// An object and not a function, so that it is inlined where it is handed on.
constexpr auto outranks = [](std::uint32_t u, std::uint32_t v) { return mix32(u) < mix32(v); };

/// Colours v unless it has to wait for a neighbour; false then. `before(u, v)` is a strict order.
template <class Word, Graph G, class Before>
bool colour_in_turn(const G& graph, std::uint32_t v, const Colours<Word>& colours,
                    const Before& before) {
  bool waits = false;
  TakenColours<Word> seen;
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    const Word colour = colours[u];
    if (colour == Colours<Word>::waiting) [[unlikely]]
      waits = waits || before(u, v);
    seen.add(colour);
  });
  if (waits) return false;
  colours.set(v, least_free(graph, v, colours, seen, [](std::uint32_t) { return true; }));
  return true;
}

/// Takes the colours of `vertices` away and gives them new ones.
template <class Word, Graph G, class Before>
void colour_by_priority(const Executor& executor, const G& graph,
                        std::vector<std::uint32_t> vertices, Colours<Word> colours,
                        const Before& before) {
  const LoopOptions loop{.grain = 16, .serial_below = 128};
  parallel_for(
      executor, vertices.size(),
      [&](std::size_t i) { colours.set(vertices[i], Colours<Word>::waiting); }, loop);
  Worklist<std::uint32_t> later(executor, {.order = WorkOrder::arrival});
  while (!vertices.empty()) {
    parallel_for(
        executor, vertices.size(),
        [&](std::size_t i) {
          if (!colour_in_turn(graph, vertices[i], colours, before)) later.append(vertices[i]);
        },
        loop);
    later.collect();
    vertices = later.take();
  }
}

inline std::vector<std::uint32_t> listed(const VertexSet& vertices) {
  std::vector<std::uint32_t> all(vertices.count);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = vertices[i];
  return all;
}

struct ByPriority {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    colour_by_priority(executor, graph, listed(vertices), colours, outranks);
  }
};

/// Greater degrees first, or greater binary logarithms of them, which makes shorter chains of
/// vertices that wait for each other (Hasenplaugh et al., SPAA 2014). Ties by hash.
template <bool OfLogarithm>
struct ByDegree {
  template <class Word, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Word> colours) {
    std::vector<std::uint32_t> size_of(colours.vertex_count());
    parallel_for(executor, vertices.count,
                 [&](std::size_t i) {
                   std::uint32_t degree = 0;
                   graph.for_each_neighbour(vertices[i], [&](std::uint32_t) { ++degree; });
                   size_of[vertices[i]] =
                       OfLogarithm ? static_cast<std::uint32_t>(std::bit_width(degree)) : degree;
                 },
                 {.grain = 256, .serial_below = 1024});
    colour_by_priority(executor, graph, listed(vertices), colours,
                       [&](std::uint32_t u, std::uint32_t v) {
                         return size_of[u] != size_of[v] ? size_of[u] > size_of[v] : outranks(u, v);
                       });
  }
};

}  // namespace ductile::runtime::detail
