/// @file
/// What all colouring methods share: the words that hold colours while a method runs, the set of
/// vertices it colours, and first-fit for one vertex.
/// While a method runs a colour takes one byte, or four if a byte is too short or the colours are
/// already in a caller's array. Colours are read and written as relaxed atomics: a colour carries
/// no other data, and what must not be missed is ordered by the barrier that ends a loop.
#pragma once

#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"

namespace ductile::runtime::detail {

/// Vertices: all below `count`, or those listed; in ascending order unless a method takes any.
struct VertexSet {
  std::size_t count;
  const std::uint32_t* list = nullptr;

  std::uint32_t operator[](std::size_t i) const {
    return list == nullptr ? static_cast<std::uint32_t>(i) : list[i];
  }
};

/// A colour does not fit into the words; the colouring starts again with longer ones.
struct TooManyColours {};

template <std::unsigned_integral Word>
class Colours {
 public:
  static constexpr Word none = static_cast<Word>(~Word{0});  ///< not yet coloured
  static constexpr Word waiting = none - 1;                  ///< lost its colour, will get another

  explicit Colours(std::span<Word> words) : words_(words) {}

  std::size_t vertex_count() const { return words_.size(); }
  Word operator[](std::uint32_t v) const {
    return std::atomic_ref(words_[v]).load(std::memory_order_relaxed);
  }
  void set(std::uint32_t v, Word colour) const {
    std::atomic_ref(words_[v]).store(colour, std::memory_order_relaxed);
  }

 private:
  std::span<Word> words_;
};

/// least_free() for a vertex whose neighbours have many colours: 64 of them at a time.
template <class Word, Graph G, class Counts>
[[gnu::noinline]] Word least_free_of_many(const G& graph, std::uint32_t v, Colours<Word> colours,
                                          Counts counts) {
  for (std::uint32_t base = 0;; base += 64) {
    std::uint64_t taken = 0;
    graph.for_each_neighbour(v, [&](std::uint32_t u) {
      if (!counts(u)) return;
      const std::uint32_t colour = std::uint32_t{colours[u]} - base;
      taken |= std::uint64_t{colour < 64} << (colour & 63U);
    });
    if (~taken == 0) continue;
    const std::uint32_t free = base + static_cast<std::uint32_t>(std::countr_one(taken));
    if (free >= Colours<Word>::waiting) throw TooManyColours{};
    return static_cast<Word>(free);
  }
}

/// What a look at a vertex's neighbours shows.
/// Colours below 62 are bits of `taken`; `waiting` and `none` fall on the bits above them. Any
/// other colour shows in the bits of `high` from 64 up.
template <class Word>
struct TakenColours {
  std::uint64_t taken = 0;
  Word high = 0;

  void add(Word colour) {
    taken |= std::uint64_t{1} << (colour & 63U);
    high |= static_cast<Word>(colour + 2);
  }
};

template <class Word, Graph G, class Counts>
Word least_free(const G& graph, std::uint32_t v, Colours<Word> colours, TakenColours<Word> seen,
                Counts counts) {
  const auto free = static_cast<std::uint32_t>(std::countr_one(seen.taken));
  if (free < 62 && seen.high < 64) [[likely]]
    return static_cast<Word>(free);
  return least_free_of_many(graph, v, colours, counts);
}

/// The least colour that none of v's neighbours u with counts(u) has; counts may be asked about a
/// neighbour again. Throws TooManyColours.
/// Inlined always: the loop over neighbours is what colouring spends its time on, and keeps what it
/// needs in registers only where the compiler sees all of it.
template <class Word, Graph G, class Counts>
[[gnu::always_inline]] inline Word least_free(const G& graph, std::uint32_t v,
                                              Colours<Word> colours, Counts counts) {
  TakenColours<Word> seen;
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    if (counts(u)) seen.add(colours[u]);
  });
  return least_free(graph, v, colours, seen, counts);
}

template <class Word, Graph G>
Word least_free(const G& graph, std::uint32_t v, Colours<Word> colours) {
  return least_free(graph, v, colours, [](std::uint32_t) { return true; });
}

/// First-fit in order, on the caller.
struct Serial {
  template <class Word, Graph G>
  static void run(const Executor&, const G& graph, VertexSet vertices, Colours<Word> colours) {
    for (std::size_t i = 0; i < vertices.count; ++i)
      colours.set(vertices[i], least_free(graph, vertices[i], colours));
  }
};

}  // namespace ductile::runtime::detail
