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
#include <type_traits>
#include <vector>

#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/fronts.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

constexpr LoopOptions speculative_loop{.grain = 256, .serial_below = 1024};

/// As many threads have two marks of their own, for their windows and for the newest vertex; more
/// look again at all that were coloured before a neighbour. The more marks, the sooner a colour is
/// beyond TakenColours.
constexpr std::uint32_t speculative_marks = 16;

/// What words of a byte become when short ones do not have enough colours.
template <class Width>
using LongOf = std::conditional_t<sizeof(typename Width::Word) == 1, OneByte<Width::marks>, Width>;

/// The first round, which colours all vertices of the graph. Where short words do not have enough
/// colours, it goes on with long ones. Who still reads those as short ones takes them for lower
/// colours, or for marks: it may pass over colours that are free, or find too soon that short words
/// do not do, but takes none that a neighbour has.
template <class Width, Graph G>
class FirstRound {
 public:
  using Long = LongOf<Width>;

  FirstRound(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor), graph_(graph), colours_(colours), suspects_(executor) {}

  /// Returns vertices in any order; of any two that clash, one at least is among them.
  UnsetVector<std::uint32_t> run() {
    Fronts fronts(graph_, static_cast<std::uint32_t>(executor_.threads()));
    parallel_for(executor_, fronts.seeds().size(),
                 [&](std::size_t i) { colour(fronts.seeds()[i]); }, {.grain = 1});
    parallel_for(executor_, fronts.count(),
                 [&](std::size_t i) {
                   while (const auto window = fronts[i].take_first()) colour(*window);
                   while (Front* const other = fronts.slowest())
                     while (const auto window = other->take_last()) colour(*window);
                 },
                 {.grain = 1});
    suspects_.collect();
    return suspects_.take();
  }

 private:
  void colour(Window window) {
    const auto mark = Colours<Width>::mark(number());
    colours_.fill(window.begin, window.end, mark);
    // Pairs with that of any other window: one of the two sees the other's marks, or its colours.
    std::atomic_thread_fence(std::memory_order_seq_cst);
    std::uint32_t done = 0;
    if constexpr (!std::is_same_v<Width, Long>) {
      // Relaxed: whoever has not heard of it finds out for itself.
      if (!long_.load(std::memory_order_relaxed)) {
        try {
          return colour_in_order<Width>(window, 0);
        } catch (const TooManyColours&) {
          long_.store(true, std::memory_order_relaxed);
          while (colours_[window[done]] != mark) ++done;
        }
      }
    }
    colour_in_order<Long>(window, done);
  }

  /// The vertices of a window but those that are done.
  template <class As>
  void colour_in_order(Window window, std::uint32_t done) {
    (window.ascending ? window.begin : window.end) += window.ascending ? done : -done;
    // Threads that share a mark cannot tell theirs from the other's.
    const bool alone = executor_.threads() <= static_cast<int>(speculative_marks);
    const Painter painter{alone ? number() : Width::marks, number() + speculative_marks};
    const auto suspect = [this](std::uint32_t v) { this->suspect(v); };
    const Colours<As> colours = colours_.template as<As>();
    if (window.ascending) {
      first_fit_in_order<true>(graph_, colours, window, painter, suspect);
    } else {
      first_fit_in_order<false>(graph_, colours, window, painter, suspect);
    }
  }

  [[gnu::noinline]] void suspect(std::uint32_t v) { suspects_.mine().append(v); }

  static std::uint32_t number() {
    return static_cast<std::uint32_t>(this_thread()) % speculative_marks;
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  std::atomic<bool> long_{false};  // there are more colours than short words have
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

/// Colours v anew, which has no colour meanwhile: it may be its own neighbour.
template <class Width, Graph G>
void colour_again(const G& graph, std::uint32_t v, const Colours<Width>& colours) {
  colours.set(v, Colours<Width>::waiting);
  colours.set(v, least_free(graph, v, colours));
}

/// When those that clash get other colours.
enum class Recolouring { at_once, when_all_are_found };

/// Gives other colours to vertices of a list until none clashes. Of any two that clash, one at
/// least is on it.
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
  static constexpr bool lengthens = true;  ///< given short words, goes on with long ones

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> words) {
    recolour_clashing<when>(executor, graph, FirstRound<Width, G>(executor, graph, words).run(),
                            words.template as<LongOf<Width>>());
  }
};

/// The scheme of Catalyurek et al.: colour, barrier, find the clashes, barrier.
using TwoPhase = Speculation<Recolouring::when_all_are_found>;

/// The scheme of Rokos et al.: who finds a clash recolours at once and is looked at again in the
/// next round; a barrier separates rounds, none is within.
using DetectAgain = Speculation<Recolouring::at_once>;

}  // namespace ductile::runtime::detail
