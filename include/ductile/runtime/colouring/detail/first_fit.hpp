/// @file
/// Shared by all colouring methods: the words that hold colours while a method runs, the set of
/// vertices it colours, and first-fit for one vertex.
/// While a method runs, a colour takes one byte, or four if there are many or they are already in a
/// caller's array. Colours are read and written as relaxed atomics: a colour carries no other data,
/// and the barrier that ends a loop orders whatever must not be missed.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::runtime::detail {

/// All vertices below `count`, or those listed, in ascending order unless the method takes any.
struct VertexSet {
  std::size_t count;
  const std::uint32_t* list = nullptr;

  std::uint32_t operator[](std::size_t i) const {
    return list == nullptr ? static_cast<std::uint32_t>(i) : list[i];
  }
};

/// Vertices [begin, end), to be coloured in ascending order.
struct Window {
  std::uint32_t begin, end;

  std::uint32_t size() const { return end - begin; }
};

/// Thrown if these words cannot hold a colour; the colouring continues, or restarts, with longer
/// ones.
struct TooManyColours {};

/// Words that hold colours. The two greatest mean that a vertex has no colour; below them are Marks
/// marks. A vertex being coloured shows a mark, instead of a colour, that says by whom: so reading
/// the neighbours' colours also reveals at no cost whether others are being coloured, because a
/// mark is one more bit of TakenColours. Each method says how many marks it needs.
template <std::unsigned_integral W, std::uint32_t Marks>
struct Words {
  using Word = W;
  static constexpr std::uint32_t marks = Marks;
  static constexpr Word most = static_cast<Word>(~Word{0}) - 2 - Marks;  ///< greatest colour
};
template <std::uint32_t Marks = 0>
using OneByte = Words<std::uint8_t, Marks>;
/// So few colours that TakenColours has room for all, which saves a range check.
template <std::uint32_t Marks = 0>
struct Narrow : OneByte<Marks> {
  static constexpr std::uint8_t most = 61 - Marks;
};
template <std::uint32_t Marks = 0>
using FourBytes = Words<std::uint32_t, Marks>;

template <class Width>
class Colours {
 public:
  using Word = typename Width::Word;
  static constexpr Word none = static_cast<Word>(~Word{0});  ///< not yet coloured
  static constexpr Word waiting = none - 1;                  ///< lost its colour and will get
                                                             ///< another
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;
  /// Stands for a colour while the thread with this number colours the vertex.
  static constexpr Word mark(std::uint32_t number) {
    return static_cast<Word>(waiting - 1 - number);
  }

  explicit Colours(std::span<Word> words) : words_(words) {}

  std::span<Word> words() const { return words_; }

  std::size_t vertex_count() const { return words_.size(); }
  Word operator[](std::uint32_t v) const {
    return std::atomic_ref(words_[v]).load(std::memory_order_relaxed);
  }
  void set(std::size_t v, Word colour) const {
    std::atomic_ref(words_[v]).store(colour, std::memory_order_relaxed);
  }
  /// Sets words [begin, end), eight bytes per store, because compilers do not merge atomic stores.
  /// Concurrent reads of single words are allowed by GCC's and Clang's atomics, not by the
  /// language.
  void fill(std::size_t begin, std::size_t end, Word colour) const {
    using Many [[gnu::may_alias]] = std::uint64_t;
    constexpr std::size_t step = sizeof(Many) / sizeof(Word);
    constexpr auto ones = static_cast<Word>(~Word{0});
    const Many many = ~Many{0} / ones * colour;
    const auto begins_many = [this](std::size_t v) {
      return reinterpret_cast<std::uintptr_t>(&words_[v]) % sizeof(Many) == 0;
    };
    std::size_t v = begin;
    for (; v < end && !begins_many(v); ++v) set(v, colour);
    for (; v + step <= end; v += step)
      __atomic_store_n(reinterpret_cast<Many*>(&words_[v]), many, __ATOMIC_RELAXED);
    for (; v < end; ++v) set(v, colour);
  }

 private:
  std::span<Word> words_;
};

/// The bit of TakenColours for a word, given `count` colours. A table lookup is faster than telling
/// colours from marks and from colours beyond the count.
template <std::uint32_t count>
struct BitOfByte {
  static constexpr std::array<std::uint64_t, 256> table = [] {
    std::array<std::uint64_t, 256> bit_of{};
    for (std::uint32_t word = 0; word < 256; ++word)
      if (word < count || word >= 256 - 64 + count) bit_of[word] = std::uint64_t{1} << word % 64;
    return bit_of;
  }();
};

/// The lowest colours that a vertex's neighbours have, as bits. A View is Colours, or a part of
/// them.
template <class View>
struct TakenColours {
  static constexpr std::uint32_t count = 62 - View::marks;

  std::uint64_t bits = 0;  ///< marks, `waiting` and `none` are bits beyond the count

  void add(std::uint32_t word) {  // not a byte, which GCC 12 may put into mask registers
    if constexpr (View::most < count) {
      bits |= std::uint64_t{1} << (word & 63U);
    } else if constexpr (sizeof(typename View::Word) == 1) {
      bits |= BitOfByte<count>::table[word];
    } else {  // words that are not colours wrap around, from the last to before the first
      bits |= std::uint64_t{word + (64 - count) < 64} << (word & 63U);
    }
  }
  /// The bit of the lowest free colour; 0 if there is none.
  std::uint64_t least_free() const {
    constexpr std::uint64_t colours = (std::uint64_t{1} << count) - 1;
    return ~bits & (bits + 1) & colours;
  }
  static std::uint64_t bit_of_mark(std::uint32_t number) {
    return std::uint64_t{1} << (61 - number);
  }
  /// The bits of `waiting` and of all marks except these. A number without a mark is nobody's.
  static std::uint64_t others(std::same_as<std::uint32_t> auto... numbers) {
    // except that of `none`
    constexpr std::uint64_t all = ~std::uint64_t{0} << count << 1U >> 1U;
    return all & ~(bit_of_mark(numbers) | ...);
  }
  bool shows_others(std::uint32_t number) const { return (bits & others(number)) != 0; }
};

/// A graph for loops over many vertices: a copy if it is a small view, which the compiler can keep
/// in registers because no store of a colour can alias it; otherwise the graph itself.
template <Graph G>
decltype(auto) in_registers(const G& graph) {
  if constexpr (std::is_trivially_copyable_v<G> && sizeof(G) <= 32) {
    return G(graph);
  } else {
    return (graph);
  }
}

/// Vertices ahead: covers the latency of memory at some nanoseconds per vertex.
constexpr std::size_t prefetch_distance = 32;

/// Prefetches the neighbours of the vertex some steps after number i. Inlined always, see CsrGraph.
template <Graph G>
[[gnu::always_inline]] inline void prefetch_after(const G& graph, const VertexSet& vertices,
                                                  std::size_t i) {
  if constexpr (PrefetchingGraph<G>)
    if (i + prefetch_distance < vertices.count) graph.prefetch(vertices[i + prefetch_distance]);
}

/// Calls visit(u) for all of a row, two per iteration. A loop of one per iteration, with half a
/// dozen instructions, takes one or two cycles each depending on its alignment. The empty statement
/// hides the trip count from GCC, which would otherwise compute the final `u` with four more
/// instructions.
template <class Visit>
[[gnu::always_inline]] inline void visit_in_pairs(const std::uint32_t* u, const std::uint32_t* end,
                                                  Visit visit) {
  if (u == end) return;
  const std::uint32_t* const last = end - 1;
  for (; u < last; u += 2) {
    visit(u[0]);
    visit(u[1]);
    asm("" : "+r"(u));
  }
  if (u == last) visit(*u);
}

/// Calls visit(u) for every neighbour of v.
template <Graph G, class Visit>
[[gnu::always_inline]] inline void visit_in_pairs(const G& graph, std::uint32_t v, Visit visit) {
  if constexpr (RowGraph<G>) {
    const std::span<const std::uint32_t> row = graph.row(v);
    visit_in_pairs(row.data(), row.data() + row.size(), visit);
  } else {
    graph.for_each_neighbour(v, visit);
  }
}

/// The lowest free colour, however many there are. It reads each neighbour once for all colours:
/// others may change theirs meanwhile, and counting both the old and the new colour of a neighbour
/// could give a colour beyond the degree.
template <Graph G, class View>
[[gnu::noinline]] typename View::Word least_free_of_many(const G& graph, std::uint32_t v,
                                                         View colours) {
  constexpr std::size_t words = 16;
  std::array<std::uint64_t, words> taken{};
  std::size_t neighbours = 0;
  graph.for_each_neighbour(v, [&](std::uint32_t u) {
    const std::size_t colour = colours[u];
    if (colour < 64 * words) taken[colour / 64] |= std::uint64_t{1} << (colour % 64);
    ++neighbours;
  });
  const auto word =
      std::find_if(taken.begin(), taken.end(), [](std::uint64_t bits) { return ~bits != 0; });
  std::size_t free = 64 * static_cast<std::size_t>(word - taken.begin());
  if (word != taken.end()) {
    free += static_cast<std::size_t>(std::countr_one(*word));
  } else {
    std::vector<bool> is_taken(neighbours + 1);
    graph.for_each_neighbour(v, [&](std::uint32_t u) {
      const std::size_t colour = colours[u];
      if (colour <= neighbours) is_taken[colour] = true;
    });
    free = static_cast<std::size_t>(std::find(is_taken.begin(), is_taken.end(), false) -
                                    is_taken.begin());
  }
  if (free > View::most) throw TooManyColours{};
  return static_cast<typename View::Word>(free);
}

/// The lowest free colour, among those shown by the neighbours already read, or beyond them. Throws
/// TooManyColours.
template <Graph G, class View>
typename View::Word least_free(const G& graph, std::uint32_t v, View colours,
                               TakenColours<View> seen) {
  const auto free = static_cast<std::uint32_t>(std::countr_one(seen.bits));
  if (free < TakenColours<View>::count) [[likely]]
    return static_cast<typename View::Word>(free);
  return least_free_of_many(graph, v, colours);
}

/// The result of reading a vertex's neighbours. Members are wide so that compilers keep each in a
/// register.
template <class Word>
struct Fit {
  Word colour;                ///< the lowest that no neighbour has
  std::uint64_t sees_others;  ///< 1 if one is `waiting`, or has another's mark
};

/// Number of neighbours from which ShownBytes pays.
constexpr std::size_t many_neighbours = 128;

/// Can bytes hold more colours than TakenColours?
template <class View>
constexpr bool has_many_colours =
    sizeof(typename View::Word) == 1 && View::most >= TakenColours<View>::count;

/// The set of bytes that the neighbours of a vertex show: it has room for all colours, so one pass
/// is enough, but takes longer to clear and search than TakenColours.
template <class Width>
class ShownBytes {
 public:
  void add(std::uint8_t byte) { shown_[byte] = 1; }

  /// Throws TooManyColours.
  std::uint8_t least_free() const {
    const void* const free = std::memchr(shown_.data(), 0, std::size_t{Width::most} + 1);
    if (free == nullptr) throw TooManyColours{};
    return static_cast<std::uint8_t>(static_cast<const std::uint8_t*>(free) - shown_.data());
  }
  bool shows_others(std::uint32_t number) const {
    const std::size_t own = number < Width::marks ? Colours<Width>::mark(number) : shown_.size();
    for (std::size_t byte = Width::most + 1; byte + 1 < shown_.size(); ++byte)
      if (shown_[byte] != 0 && byte != own) return true;
    return false;
  }

 private:
  alignas(64) std::array<std::uint8_t, 256> shown_{};
};

/// first_fit() for a vertex with many neighbours.
template <RowGraph G, class Width>
[[gnu::noinline]] Fit<std::uint8_t> first_fit_of_many(const G& graph, std::uint32_t v,
                                                      Colours<Width> colours,
                                                      std::uint32_t number) {
  ShownBytes<Width> seen;
  visit_in_pairs(graph, v, [&](std::uint32_t u) { seen.add(colours[u]); });
  return {seen.least_free(), seen.shows_others(number)};
}

/// The colour for v, coloured by the thread with this number. Throws TooManyColours. Always
/// inlined: colouring spends its time in the loop over neighbours, which keeps its data in
/// registers only if the compiler sees all of it.
template <Graph G, class View>
[[gnu::always_inline]] inline Fit<typename View::Word> first_fit(const G& graph, std::uint32_t v,
                                                                 View colours,
                                                                 std::uint32_t number) {
  if constexpr (RowGraph<G> && has_many_colours<View>)
    if (graph.row(v).size() >= many_neighbours) {
      const auto [colour, sees_others] = first_fit_of_many(graph, v, colours, number);
      return {colour, sees_others};
    }
  TakenColours<View> seen;
  visit_in_pairs(graph, v, [&](std::uint32_t u) { seen.add(colours[u]); });
  return {least_free(graph, v, colours, seen), seen.shows_others(number)};
}

/// The lowest colour that no neighbour of v has. Throws TooManyColours.
template <Graph G, class View>
[[gnu::always_inline]] inline typename View::Word least_free(const G& graph, std::uint32_t v,
                                                             View colours) {
  return first_fit(graph, v, colours, 0).colour;
}

}  // namespace ductile::runtime::detail
