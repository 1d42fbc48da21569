/// @file
/// First-fit of vertices one after the other. In most orders each is a neighbour of the one before,
/// whose colour, just stored, takes long to be read back: on Zen 5 some 15 cycles, more than all
/// else that a vertex of six neighbours costs. So the newest vertex shows, until the next one's
/// neighbours have been looked at, a mark where its colour will be, and who sees that mark takes
/// the colour from a register.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/fronts.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::runtime::detail {

/// Who colours: the number of the mark that its vertices show at first, and of the one that the
/// newest shows. If `number` is that of no mark, all marks count as those of others. After the
/// window come the vertices that follow it.
struct Painter {
  std::uint32_t number, newest;
};

/// One that goes up, and is likely to go on elsewhere, at `next`.
struct LeavingPainter : Painter {
  std::uint32_t next;
};

/// One that calls what shows these bits others, and nothing else.
struct HeedingPainter : LeavingPainter {
  std::uint64_t heeded;
};

/// The rows of a window's vertices, up or down, and asks for those to come.
template <Graph G, bool ascending, bool leaves>
class RowsInOrder {
 public:
  RowsInOrder(const G& graph, Window window, std::uint32_t next)
      : graph_(in_registers(graph)), end_(window.end), jump_(next - window.end) {}

  /// Whether v, which has its turn, has at least so many neighbours.
  bool is_long(std::uint32_t v, std::size_t least) const {
    if constexpr (RowGraph<G>) return graph_.row(v).size() >= least;
    return false;
  }
  void pass(std::uint32_t) {}
  template <class Visit>
  [[gnu::always_inline]] void visit(std::uint32_t v, Visit see) {
    if constexpr (ascending) {
      const bool jumps = leaves && v + prefetch_distance_of<G>() >= end_;
      prefetch_after(graph_, {graph_.vertex_count()}, jumps ? v + jump_ : v);
    } else {
      prefetch_before(graph_, v);
    }
    visit_in_pairs(graph_, v, see);
  }

 private:
  decltype(in_registers(std::declval<const G&>())) graph_;
  std::uint32_t end_, jump_;
};

/// Where a row begins the one before ends: one address to find for each, not two; and what comes
/// next in memory are rows to come. Who leaves asks in each step for a place as far from `next` as
/// it is from the window's first vertex.
template <PackedRowGraph G, bool ascending, bool leaves>
class RowsInOrder<G, ascending, leaves> {
 public:
  RowsInOrder(const G& graph, Window window, std::uint32_t next)
      : graph_(graph),
        edge_(graph.row_begin(ascending ? window.begin : window.end)),
        jump_(leaves ? address_of(graph.row_begin(next)) - address_of(edge_) : 0) {}

  bool is_long(std::size_t v, std::size_t least) const {
    const std::uint32_t* const other = other_edge(v);
    return static_cast<std::size_t>(ascending ? other - edge_ : edge_ - other) >= least;
  }
  void pass(std::size_t v) { edge_ = other_edge(v); }
  template <class Visit>
  [[gnu::always_inline]] void visit(std::size_t v, Visit see) {
    const std::uint32_t* const other = other_edge(v);
    const std::uint32_t* const edge = std::exchange(edge_, other);
    prefetch(edge);
    visit_in_pairs(ascending ? edge : other, ascending ? other : edge, see);
  }

 private:
  const std::uint32_t* other_edge(std::size_t v) const {
    return graph_.row_begin(ascending ? v + 1 : v);
  }
  /// Of what may lie outside of the array, where it does nothing; a pointer may not go there, so
  /// the address is computed as an integer. 1024 to 4096 bytes ahead take the same time.
  [[gnu::always_inline]] void prefetch(const std::uint32_t* edge) const {
    constexpr std::uintptr_t near = 1536;
    const std::uintptr_t ahead = leaves ? jump_ : ascending ? near : -near;
    // Nothing is optimised away by this cast, as the check fears: it is only prefetched.
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    __builtin_prefetch(reinterpret_cast<const void*>(address_of(edge) + ahead));
  }
  static std::uintptr_t address_of(const std::uint32_t* edge) {
    return reinterpret_cast<std::uintptr_t>(edge);
  }

  G graph_;
  const std::uint32_t* edge_;
  std::uintptr_t jump_;
};

template <bool ascending, Graph G, std::derived_from<Painter> P>
auto rows_in_order(const G& graph, Window window, P painter) {
  if constexpr (requires { painter.next; }) {
    return RowsInOrder<G, ascending, true>(graph, window, painter.next);
  } else {
    return RowsInOrder<G, ascending, false>(graph, window, window.end);
  }
}

/// What is called for who sees others colours it, and returns what it shows from then on.
template <class SawOthers>
constexpr bool colours_itself = !std::is_void_v<std::invoke_result_t<SawOthers, std::uint32_t>>;

/// The same as first_fit_in_order for a vertex of many neighbours; returns what it shows.
template <RowGraph G, class Width, class SawOthers>
std::uint8_t colour_of_many(const G& graph, std::uint32_t v, Colours<Width> colours,
                            std::uint32_t number, SawOthers saw_others) {
  if constexpr (colours_itself<SawOthers>) {
    return saw_others(v);
  } else {
    const auto [fit, sees_others] = first_fit_of_many(graph, v, colours, number);
    colours.set(v, fit);
    if (sees_others != 0) saw_others(v);
    return fit;
  }
}

/// What the neighbours of v show, as bits of TakenColours.
template <class Rows, class Width>
[[gnu::always_inline]] inline std::uint64_t shown_to(std::size_t v, Rows& rows,
                                                     Colours<Width> colours) {
  std::uint64_t bits = 0;
  rows.visit(v, [&](std::uint32_t u) {
    TakenColours<Colours<Width>> seen{bits};
    seen.add(colours[u]);
    bits = seen.bits;
    asm("" : "+r"(bits));  // one after the other takes a register less
  });
  return bits;
}

/// First-fit of the vertices of a window, in its order. Calls saw_others(v) if v sees one that is
/// `waiting`, or has a mark of others; where that colours v itself, it is called for who has many
/// neighbours, too, before they are looked at. Throws TooManyColours: the vertices before then show
/// their colours, and those to come what they showed. Not inlined, so that the loop has the
/// registers it needs; aligned, as on Zen 4 first-fit takes up to a third more time where the end
/// of the loop happens to lie across two lines of the cache.
template <bool ascending, class Width, Graph G, std::derived_from<Painter> P, class SawOthers>
[[gnu::noinline, gnu::aligned(64)]] void first_fit_in_order(const G& graph, Colours<Width> colours,
                                                            Window window, P painter,
                                                            SawOthers saw_others) {
  using Word = typename Width::Word;
  using Seen = TakenColours<Colours<Width>>;
  auto rows = rows_in_order<ascending>(graph, window, painter);
  const Word mark = Colours<Width>::mark(painter.newest);
  std::uint64_t mark_bit = std::uint64_t{1} << (mark & 63U);
  asm("" : "+r"(mark_bit));  // as long as GCC knows it, it makes a branch of a look at it
  const std::uint32_t own = painter.number < Width::marks ? painter.newest : painter.number;
  std::uint64_t others = Seen::others(painter.number, own);
  if constexpr (std::same_as<P, HeedingPainter>) others = painter.heeded;
  asm("" : "+r"(others));  // else GCC puts it together anew for each vertex

  Word newest = Colours<Width>::none;  // the colour of the newest vertex
  std::uint64_t newest_bit = 0;        // what that is in TakenColours
  const auto show_newest = [&](std::size_t v, bool is_first) {
    if (!is_first) colours.set(ascending ? v - 1 : v + 1, newest);
  };
  const auto colour = [&](std::size_t v, bool is_first) __attribute__((always_inline)) {
    const auto id = static_cast<std::uint32_t>(v);
    if constexpr (RowGraph<G> && has_many_colours<Colours<Width>>)
      if (rows.is_long(id, many_neighbours)) [[unlikely]] {
        rows.pass(v);
        show_newest(v, is_first);
        newest = colour_of_many(graph, id, colours, painter.number, saw_others);
        return;
      }
    Seen seen{shown_to(v, rows, colours)};
    show_newest(v, is_first);
    const bool sees_others = (seen.bits & others) != 0;
    if constexpr (colours_itself<SawOthers>)
      if (sees_others) [[unlikely]] {
        newest = saw_others(id);
        return;
      }
    const std::uint64_t all = seen.bits | newest_bit;
    if (__builtin_expect_with_probability((all & mark_bit) != 0, 1, 0.5)) seen.bits = all;
    newest_bit = seen.least_free();
    newest = newest_bit != 0 ? static_cast<Word>(std::countr_zero(newest_bit))
                             : least_free_of_many(graph, id, colours);
    colours.set(v, mark);
    if constexpr (!colours_itself<SawOthers>)
      if (sees_others) [[unlikely]]
        saw_others(id);
  };
  colour(window[0], true);
  if constexpr (ascending) {
    for (std::size_t v = std::size_t{window.begin} + 1; v < window.end; ++v) colour(v, false);
  } else {
    for (std::size_t v = window.end - 1; v-- > window.begin;) colour(v, false);
  }
  colours.set(window[window.size() - 1], newest);
}

/// First-fit in order, on the caller.
struct Serial {
  static constexpr std::uint32_t marks = 1;
  static constexpr bool resumes = true;  ///< goes on after TooManyColours, given longer words

  template <class Width, Graph G>
  static void run(const Executor&, const G& graph, VertexSet vertices, Colours<Width> colours) {
    std::size_t i = 0;
    while (i < vertices.count && colours[vertices[i]] != Colours<Width>::none) ++i;
    if constexpr (Width::marks > 0) {
      if (vertices.list == nullptr) {
        const Window rest{static_cast<std::uint32_t>(i),
                          static_cast<std::uint32_t>(vertices.count)};
        if (rest.size() > 0)
          first_fit_in_order<true>(graph, colours, rest, Painter{Width::marks, 0},
                                   [](std::uint32_t) {});
        return;
      }
    }
    const auto& rows = in_registers(graph);
    for (; i < vertices.count; ++i) {
      prefetch_after(rows, vertices, i);
      colours.set(vertices[i], least_free(rows, vertices[i], colours));
    }
  }
};

}  // namespace ductile::runtime::detail
