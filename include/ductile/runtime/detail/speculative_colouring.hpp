/// @file
/// Parallel colourings that speculate: every vertex takes the least colour it sees free, without
/// waiting for anybody; neighbours that did so at the same moment may clash, and one of them is
/// coloured again. Rounds go on until there is no clash. The colours depend on timing.
/// Threads take windows of vertices, each from a part of its own while that lasts, and mark them
/// before they start. Of two that clash one at least saw the other's mark, as each thread marks
/// before it reads: only who saw a mark is looked at again.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

constexpr LoopOptions speculative_loop{.grain = 256, .serial_below = 1024};

/// As many threads know their own windows; more look again at all that were coloured before a
/// neighbour. The more marks, the sooner a colour is beyond TakenColours.
constexpr std::uint32_t speculative_marks = 16;

/// The first round, which colours all vertices of the graph.
template <class Width, Graph G>
class FirstRound {
 public:
  FirstRound(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        colours_(colours),
        suspects_(executor, {.order = WorkOrder::arrival}) {}

  /// Returns vertices in any order; of any two that clash, one at least is among them.
  std::vector<std::uint32_t> run() {
    const auto threads = static_cast<std::size_t>(executor_.threads());
    const std::size_t n = colours_.vertex_count();
    const std::size_t size = std::clamp<std::size_t>(n / (32 * threads), 64, 1024);
    parallel_for_blocks(executor_, n, size, [&](std::size_t, std::size_t begin, std::size_t end) {
      colour_window(begin, end);
    });
    suspects_.collect();
    return suspects_.take();
  }

 private:
  void colour_window(std::size_t begin, std::size_t end) {
    const auto& rows = in_registers(graph_);
    const Colours<Width> colours = colours_;
    const std::uint32_t thread = static_cast<std::uint32_t>(this_thread()) % Width::marks;
    // Threads that share a mark cannot tell theirs from the other's.
    const bool alone = executor_.threads() <= static_cast<int>(Width::marks);
    for (std::size_t i = begin; i < end; ++i)
      colours.set(static_cast<std::uint32_t>(i), Colours<Width>::mark(thread));
    // Pairs with that of any other window: one of the two sees the other's marks, or its colours.
    std::atomic_thread_fence(std::memory_order_seq_cst);
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_after(rows, {colours.vertex_count()}, i);
      const auto v = static_cast<std::uint32_t>(i);
      TakenColours<Colours<Width>> seen;
      rows.for_each_neighbour(v, [&](std::uint32_t u) { seen.add(colours[u]); });
      colours.set(v, least_free(rows, v, colours, seen));
      if (seen.shows_others(alone ? thread : none_of_them)) [[unlikely]]
        suspects_.append(v);
    }
  }

  static constexpr std::uint32_t none_of_them = Width::marks;

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  Worklist<std::uint32_t> suspects_;
};

/// Whom a vertex must differ from to be left as it is. Any may clash with a suspect of the first
/// round, which knows of it alone; later both are listed, and the one of lower id stays.
enum class Rivals { all, lower };

template <class Width, Graph G>
bool clashes(const G& graph, std::uint32_t v, const Colours<Width>& colours, Rivals rivals) {
  const std::uint32_t own = colours[v];
  unsigned clash = 0;
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    const bool counts = rivals == Rivals::all ? u != v : u < v;
    clash |= static_cast<unsigned>(counts) & static_cast<unsigned>(colours[u] == own);
  });
  return clash != 0;
}

/// The scheme of Catalyurek et al.: colour, barrier, find the clashes, barrier.
struct TwoPhase {
  static constexpr std::uint32_t marks = speculative_marks;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> colours) {
    std::vector<std::uint32_t> list = FirstRound<Width, G>(executor, graph, colours).run();
    Worklist<std::uint32_t> clashing(executor, {.order = WorkOrder::arrival});
    for (Rivals rivals = Rivals::all; !list.empty(); rivals = Rivals::lower) {
      parallel_for(
          executor, list.size(),
          [&](std::size_t i) {
            prefetch_after(graph, {list.size(), list.data()}, i);
            if (clashes(graph, list[i], colours, rivals)) clashing.append(list[i]);
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
  static constexpr std::uint32_t marks = speculative_marks;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> colours) {
    std::vector<std::uint32_t> list = FirstRound<Width, G>(executor, graph, colours).run();
    Worklist<std::uint32_t> recoloured(executor, {.order = WorkOrder::arrival});
    for (Rivals rivals = Rivals::all; !list.empty(); rivals = Rivals::lower) {
      parallel_for(
          executor, list.size(),
          [&](std::size_t i) {
            const std::uint32_t v = list[i];
            prefetch_after(graph, {list.size(), list.data()}, i);
            if (!clashes(graph, v, colours, rivals)) return;
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
