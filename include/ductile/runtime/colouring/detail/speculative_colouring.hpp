/// @file
/// Speculative parallel colouring: every vertex takes the lowest colour it sees free, without
/// waiting; neighbours coloured at the same moment may clash, and then one of them is recoloured.
/// Rounds continue until there is no clash. The colours depend on timing.
/// Threads take windows of vertices and mark them first.
/// Of two vertices that clash, at least one saw the other's mark, because threads mark before they
/// read: so only vertices that saw a mark are checked again.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

constexpr LoopOptions speculative_loop{.grain = 256, .serial_below = 1024};

/// Up to this many threads have two marks of their own, for their windows and for the newest
/// vertex; beyond it, threads recheck all vertices coloured before a neighbour. More marks leave
/// fewer colours to TakenColours.
constexpr std::uint32_t speculative_marks = 16;

/// The first round, which colours all vertices.
template <class Width, Graph G>
class FirstRound {
 public:
  FirstRound(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor), graph_(graph), colours_(colours), suspects_(executor) {}

  /// Returns vertices in any order; of any two that clash, at least one is included.
  UnsetVector<std::uint32_t> run() {
    const auto n = std::uint64_t{graph_.vertex_count()};
    const auto threads = static_cast<std::uint64_t>(executor_.threads());
    parallel_for_blocks(
        executor_, n, std::clamp<std::uint64_t>(n / (32 * threads), 64, 1024),
        [&](std::size_t, std::size_t begin, std::size_t end) {
          colour({static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
        });
    suspects_.collect();
    return suspects_.take();
  }

 private:
  void colour(Window window) {
    colours_.fill(window.begin, window.end, Colours<Width>::mark(number()));
    // Pairs with the fence of any other window: one of the two sees the other's marks or colours.
    std::atomic_thread_fence(std::memory_order_seq_cst);
    // Threads that share a mark cannot tell their vertices from the other's.
    const bool alone = executor_.threads() <= static_cast<int>(speculative_marks);
    const Painter painter{alone ? number() : Width::marks, number() + speculative_marks};
    first_fit_in_order(graph_, colours_, window, painter,
                       [this](std::uint32_t v) { this->suspect(v); });
  }

  [[gnu::noinline]] void suspect(std::uint32_t v) { suspects_.mine().append(v); }

  static std::uint32_t number() {
    return static_cast<std::uint32_t>(this_thread()) % speculative_marks;
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  Worklist<std::uint32_t> suspects_;
};

/// The neighbours that a vertex must differ from to keep its colour. In the first round any,
/// because only one of two that clash may be suspect; later both are listed and the lower id stays.
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

/// Recolours v, which is uncoloured meanwhile because it may be its own neighbour.
template <class Width, Graph G>
void colour_again(const G& graph, std::uint32_t v, const Colours<Width>& colours) {
  colours.set(v, Colours<Width>::waiting);
  colours.set(v, least_free(graph, v, colours));
}

/// When clashing vertices get other colours.
enum class Recolouring { at_once, when_all_are_found };

/// Recolours vertices of a list until none clashes. Of any two that clash, at least one is listed.
template <Recolouring when, class Width, Graph G>
void recolour_clashing(const Executor& executor, const G& graph, UnsetVector<std::uint32_t> list,
                       const Colours<Width>& colours) {
  Worklist<std::uint32_t> clashing(executor);
  for (Rivals rivals = Rivals::all; !list.empty(); rivals = Rivals::lower) {
    const auto look_at = [&](std::size_t i, auto& mine) {
      prefetch_after(graph, {list.size(), list.data()}, i);
      if (!clashes(graph, list[i], colours, rivals)) return;
      if (when == Recolouring::at_once) colour_again(graph, list[i], colours);
      mine.append(list[i]);
    };
    parallel_for(executor, list.size(), with(clashing), look_at, speculative_loop);
    clashing.collect();
    list = clashing.take();
    if (when == Recolouring::at_once) continue;
    parallel_for(
        executor, list.size(), [&](std::size_t i) { colour_again(graph, list[i], colours); },
        speculative_loop);
  }
}

template <Recolouring when>
struct Speculation {
  static constexpr std::uint32_t marks = 2 * speculative_marks;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> words) {
    recolour_clashing<when>(executor, graph, FirstRound<Width, G>(executor, graph, words).run(),
                            words);
  }
};

/// The scheme of Catalyurek et al.: colour, barrier, find the clashes, barrier.
using TwoPhase = Speculation<Recolouring::when_all_are_found>;

/// The scheme of Rokos et al.: a vertex that finds a clash recolours at once and is checked again
/// in the next round; there is one barrier, between rounds.
using DetectAgain = Speculation<Recolouring::at_once>;

}  // namespace ductile::runtime::detail
