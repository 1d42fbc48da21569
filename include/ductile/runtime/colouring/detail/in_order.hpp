/// @file
/// Sequential first-fit. In most orders each vertex is a neighbour of the previous one, whose
/// colour, just stored, takes long to load back: some 15 cycles on Zen 5, more than the rest of the
/// work for six neighbours. So the newest vertex shows a mark until the neighbours of the next one
/// have been read; a vertex that sees the mark takes the colour from a register.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::runtime::detail {

/// The colouring thread: the number of the mark that its vertices show at first, and of the one
/// that the newest shows. If `number` is no mark's, all marks count as others'. The vertices after
/// the window are next.
struct Painter {
  std::uint32_t number, newest;
};

/// A painter that probably continues elsewhere, at `next`.
struct LeavingPainter : Painter {
  std::uint32_t next;
};

/// A painter that treats exactly these bits as others.
struct HeedingPainter : LeavingPainter {
  std::uint64_t heeded;
};

/// The rows of a window's vertices; prefetches the next ones.
template <Graph G, bool leaves>
class RowsInOrder {
 public:
  RowsInOrder(const G& graph, Window window, std::uint32_t next)
      : graph_(in_registers(graph)), end_(window.end), jump_(next - window.end) {}

  /// Does v, the current vertex, have at least this many neighbours?
  bool is_long(std::uint32_t v, std::size_t least) const {
    if constexpr (RowGraph<G>) return graph_.row(v).size() >= least;
    return false;
  }
  void pass(std::uint32_t) {}
  template <class Visit>
  [[gnu::always_inline]] void visit(std::uint32_t v, Visit see) {
    const bool jumps = leaves && v + prefetch_distance >= end_;
    prefetch_after(graph_, {graph_.vertex_count()}, jumps ? v + jump_ : v);
    visit_in_pairs(graph_, v, see);
  }

 private:
  decltype(in_registers(std::declval<const G&>())) graph_;
  std::uint32_t end_, jump_;
};

/// A row ends where the next one begins: one address to load per vertex, not two; and the next data
/// in memory are the next rows. A leaving painter prefetches, in each step, as far from `next` as
/// the step is from the window's first vertex.
template <PackedRowGraph G, bool leaves>
class RowsInOrder<G, leaves> {
 public:
  RowsInOrder(const G& graph, Window window, std::uint32_t next)
      : graph_(graph),
        edge_(graph.row_begin(window.begin)),
        jump_(leaves ? address_of(graph.row_begin(next)) - address_of(edge_) : 0) {}

  bool is_long(std::size_t v, std::size_t least) const {
    return static_cast<std::size_t>(graph_.row_begin(v + 1) - edge_) >= least;
  }
  void pass(std::size_t v) { edge_ = graph_.row_begin(v + 1); }
  template <class Visit>
  [[gnu::always_inline]] void visit(std::size_t v, Visit see) {
    const std::uint32_t* const end = graph_.row_begin(v + 1);
    const std::uint32_t* const begin = std::exchange(edge_, end);
    prefetch(begin);
    visit_in_pairs(begin, end, see);
  }

 private:
  /// May be called outside the array, where it does nothing; pointers may not go there, so the
  /// address is computed as an integer. 1024 to 4096 bytes ahead perform the same.
  [[gnu::always_inline]] void prefetch(const std::uint32_t* edge) const {
    constexpr std::uintptr_t near = 1536;
    const std::uintptr_t ahead = leaves ? jump_ : near;
    // The check warns of lost optimisations; here the pointer is only prefetched.
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

template <Graph G, std::derived_from<Painter> P>
auto rows_in_order(const G& graph, Window window, P painter) {
  if constexpr (requires { painter.next; }) {
    return RowsInOrder<G, true>(graph, window, painter.next);
  } else {
    return RowsInOrder<G, false>(graph, window, window.end);
  }
}

/// True if the callback for a vertex that sees others colours it and returns what it then shows.
template <class SawOthers>
constexpr bool colours_itself = !std::is_void_v<std::invoke_result_t<SawOthers, std::uint32_t>>;

/// first_fit_in_order() for a vertex with many neighbours; returns what it shows.
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

/// Bits of TakenColours that the neighbours of v show.
template <class Rows, class Width>
[[gnu::always_inline]] inline std::uint64_t shown_to(std::size_t v, Rows& rows,
                                                     Colours<Width> colours) {
  std::uint64_t bits = 0;
  rows.visit(v, [&](std::uint32_t u) {
    TakenColours<Colours<Width>> seen{bits};
    seen.add(colours[u]);
    bits = seen.bits;
    asm("" : "+r"(bits));  // sequential updates need one register less
  });
  return bits;
}

/// First-fit of the vertices of a window, in order. Calls saw_others(v) if v sees a neighbour
/// that is `waiting` or has another's mark; if that colours v itself, it is also called for
/// vertices with many neighbours, before reading them. Throws TooManyColours: vertices before then
/// show their colours, later ones what they showed before. Not inlined, so that the loop gets its
/// registers; aligned, because on Zen 4 first-fit takes up to a third longer if the loop's end
/// crosses a cache line.
template <class Width, Graph G, std::derived_from<Painter> P, class SawOthers>
[[gnu::noinline, gnu::aligned(64)]] void first_fit_in_order(const G& graph, Colours<Width> colours,
                                                            Window window, P painter,
                                                            SawOthers saw_others) {
  using Word = typename Width::Word;
  using Seen = TakenColours<Colours<Width>>;
  auto rows = rows_in_order(graph, window, painter);
  const Word mark = Colours<Width>::mark(painter.newest);
  std::uint64_t mark_bit = std::uint64_t{1} << (mark & 63U);
  asm("" : "+r"(mark_bit));  // hides the value from GCC, which would otherwise branch on it
  const std::uint32_t own = painter.number < Width::marks ? painter.newest : painter.number;
  std::uint64_t others = Seen::others(painter.number, own);
  if constexpr (std::same_as<P, HeedingPainter>) others = painter.heeded;
  asm("" : "+r"(others));  // otherwise GCC recomputes it for each vertex

  Word newest = Colours<Width>::none;  // the colour of the newest vertex
  std::uint64_t newest_bit = 0;        // the bit of `newest` in TakenColours
  const auto show_newest = [&](std::size_t v, bool is_first) {
    if (!is_first) colours.set(v - 1, newest);
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
  colour(window.begin, true);
  for (std::size_t v = std::size_t{window.begin} + 1; v < window.end; ++v) colour(v, false);
  colours.set(window.end - 1, newest);
}

/// First-fit in order, on the calling thread.
struct Serial {
  static constexpr std::uint32_t marks = 1;
  static constexpr bool resumes = true;  ///< continues after TooManyColours, given longer words

  template <class Width, Graph G>
  static void run(const Executor&, const G& graph, VertexSet vertices, Colours<Width> colours) {
    std::size_t i = 0;
    while (i < vertices.count && colours[vertices[i]] != Colours<Width>::none) ++i;
    if constexpr (Width::marks > 0) {
      if (vertices.list == nullptr) {
        const Window rest{static_cast<std::uint32_t>(i),
                          static_cast<std::uint32_t>(vertices.count)};
        if (rest.size() > 0)
          first_fit_in_order(graph, colours, rest, Painter{Width::marks, 0}, [](std::uint32_t) {});
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
