/// @file
/// Parallel colourings that speculate: every vertex takes the least colour it sees free, without
/// waiting for anybody; neighbours that did so at the same moment may clash, and one of them is
/// coloured again. Rounds go on until there is no clash. The colours depend on timing; a team of
/// one has no clashes to look for and gives serial first-fit's.
/// Threads take windows of vertices in ascending order, so that all lower vertices have a colour,
/// but for those of the windows other threads are at. Of two that clash each saw the other without
/// a colour: only who saw that of a lower vertex of another window is looked at again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/atomic_count.hpp"
#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

constexpr LoopOptions speculative_loop{.grain = 256, .serial_below = 1024};

/// The first round, which colours all vertices of the graph.
template <class Width, Graph G>
class FirstRound {
 public:
  FirstRound(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        colours_(colours),
        suspects_(executor, {.order = WorkOrder::arrival}) {}

  /// Returns, in any order, the vertices that may clash with a lower one; no others do.
  std::vector<std::uint32_t> run() {
    const auto threads = static_cast<std::size_t>(executor_.threads());
    const std::size_t n = colours_.vertex_count();
    const std::size_t size = std::clamp<std::size_t>(n / (32 * threads), 256, 16384);
    // The first window is a half, so that neighbouring windows are not in step: where ids follow
    // the graph a vertex then finds its neighbours in the window before coloured.
    const std::size_t windows = (n + size / 2 + size - 1) / size;
    parallel_for(executor_, threads,
                 [&](std::size_t) {
                   for (std::size_t w = atomic_count(next_); w < windows; w = atomic_count(next_))
                     colour_window(w * size - std::min(w * size, size / 2),
                                   std::min((w + 1) * size - size / 2, n));
                 },
                 {.grain = 1});
    suspects_.collect();
    return suspects_.take();
  }

 private:
  void colour_window(std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::uint32_t>(begin);
    const auto& rows = in_registers(graph_);
    const Colours<Width> colours = colours_;
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_after(rows, {colours.vertex_count()}, i);
      const auto v = static_cast<std::uint32_t>(i);
      TakenColours<Colours<Width>> seen;
      std::uint32_t lower = 0;  // the bits of all colours seen of lower windows
      rows.for_each_neighbour(v, [&](std::uint32_t u) {
        const std::uint32_t colour = colours[u];
        seen.add(colour);
        lower |= u < first ? colour : 0;
      });
      colours.set(v, least_free(rows, v, colours, seen));
      // No colour has the highest bit, or hardly any.
      if (lower > Colours<Width>::none / 2) [[unlikely]]
        suspects_.append(v);
    }
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  Worklist<std::uint32_t> suspects_;
  alignas(128) std::uint32_t next_ = 0;  // window
};

/// The scheme of Catalyurek et al.: colour, barrier, find the clashes, barrier.
struct TwoPhase {
  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet all, Colours<Width> colours) {
    if (executor.threads() == 1) return Serial::run(executor, graph, all, colours);
    std::vector<std::uint32_t> list = FirstRound<Width, G>(executor, graph, colours).run();
    Worklist<std::uint32_t> clashing(executor, {.order = WorkOrder::arrival});
    while (!list.empty()) {
      parallel_for(
          executor, list.size(),
          [&](std::size_t i) {
            prefetch_after(graph, {list.size(), list.data()}, i);
            if (clashes(graph, list[i], colours)) clashing.append(list[i]);
          },
          speculative_loop);
      clashing.collect();
      list = clashing.take();
      parallel_for(
          executor, list.size(),
          [&](std::size_t i) { colours.set(list[i], least_free(graph, list[i], colours)); },
          speculative_loop);
    }
  }
};

/// The scheme of Rokos et al.: who finds a clash recolours at once and is looked at again in the
/// next round; a barrier separates rounds, none is within.
struct DetectAgain {
  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet all, Colours<Width> colours) {
    if (executor.threads() == 1) return Serial::run(executor, graph, all, colours);
    std::vector<std::uint32_t> list = FirstRound<Width, G>(executor, graph, colours).run();
    Worklist<std::uint32_t> recoloured(executor, {.order = WorkOrder::arrival});
    while (!list.empty()) {
      parallel_for(
          executor, list.size(),
          [&](std::size_t i) {
            const std::uint32_t v = list[i];
            prefetch_after(graph, {list.size(), list.data()}, i);
            if (!clashes(graph, v, colours)) return;
            colours.set(v, least_free(graph, v, colours));
            recoloured.append(v);
          },
          speculative_loop);
      recoloured.collect();
      list = recoloured.take();
    }
  }
};

}  // namespace ductile::runtime::detail
