/// @file
/// First-fit in order on many threads, for graphs whose neighbours have nearby ids: each thread
/// colours a part of the vertices as if earlier parts did not exist. This guess is wrong near the
/// border, and less and less so away from it, unless the graph is a grid. Then each vertex with an
/// earlier neighbour that is in another part or has changed is recoloured in order, until all have
/// the serial colours.
/// If results may depend on timing, only clashing vertices get new colours, by the scheme with one
/// barrier per round (speculative_colouring.hpp), provided that this needs at most one colour more
/// than the first part, whose colours are serial.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/detail/speculative_colouring.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// The colours of vertices before v; `none` for others.
template <class Width>
class BeforeVertex {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;

  BeforeVertex(Colours<Width> colours, std::uint32_t v) : colours_(colours), v_(v) {}
  /// Branch-free, because a branch would be hard to predict.
  Word operator[](std::uint32_t u) const {
    const auto is_later = static_cast<Word>(u >= v_);
    return static_cast<Word>(colours_[u] | (is_later * Colours<Width>::none));
  }

 private:
  Colours<Width> colours_;
  std::uint32_t v_;
};

/// Colours all vertices of the graph.
template <class Width, Graph G>
class PartsRun {
 public:
  using Word = typename Width::Word;

  PartsRun(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        colours_(colours),
        parts_(static_cast<std::size_t>(executor.threads())) {}

  /// Throws TooManyColours and what the graph throws.
  void run() {
    for_each_part([&](std::size_t p) { colour_blindly(p); });
    for_each_part([&](std::size_t p) {
      const Window part = window(p);
      Word* const words = colours_.words().data();
      const std::vector<Word>& own = parts_[p].words;
      if (p > 0) std::copy(&own[part.begin], own.data() + part.end, words + part.begin);
      Word greatest = 0;
      for (std::uint32_t v = part.begin; v < part.end; ++v) greatest = std::max(greatest, words[v]);
      parts_[p].greatest = greatest;
    });
    UnsetVector<std::uint32_t> unsure;
    for (const Part& part : parts_)
      unsure.insert(unsure.end(), part.unsure.begin(), part.unsure.end());
    std::vector<std::uint64_t> stale(n_ / 64 + 1);  // bits of vertices to be checked again
    for (const std::uint32_t v : unsure) mark(stale, v);
    if (executor_.deterministic() || !takes_few_colours(std::move(unsure), stale)) repair(stale);
  }

 private:
  static constexpr std::uint32_t newest_mark = 0, elsewhere_mark = 1;
  struct alignas(128) Part {
    std::vector<Word> words;            // [vertex], as its thread sees them; empty for the first
                                        // part
    std::vector<std::uint32_t> unsure;  // have neighbours in earlier parts
    Word greatest = 0;
  };

  template <class Body>
  void for_each_part(Body body) {
    parallel_for(executor_, parts_.size(), body, {.grain = 1});
  }

  Window window(std::uint64_t part) const {
    const auto border = [&](std::uint64_t p) {
      return static_cast<std::uint32_t>(n_ * p / parts_.size());
    };
    return {border(part), border(part + 1)};
  }

  void colour_blindly(std::size_t p) {
    const Window part = window(p);
    std::vector<Word>& words = parts_[p].words;
    if (p > 0) {
      words.assign(n_, Colours<Width>::none);
      std::fill_n(words.begin(), part.begin, Colours<Width>::mark(elsewhere_mark));
    }
    const Colours<Width> colours = p > 0 ? Colours<Width>(words) : colours_;
    std::vector<std::uint32_t>& unsure = parts_[p].unsure;
    const auto note = [&](std::uint32_t v) __attribute__((noinline)) { unsure.push_back(v); };
    first_fit_in_order(graph_, colours, part, Painter{newest_mark, newest_mark}, note);
  }

  static void mark(std::vector<std::uint64_t>& bits, std::uint32_t v, bool is_marked = true) {
    bits[v / 64] |= std::uint64_t{is_marked} << (v % 64);
  }

  /// Recolours clashing vertices. If that takes too many colours, marks those that are stale.
  bool takes_few_colours(UnsetVector<std::uint32_t> unsure, std::vector<std::uint64_t>& stale) {
    recolour_clashing<Recolouring::at_once>(executor_, graph_, unsure, colours_);
    const Word few = parts_[0].greatest + 1;
    const bool does =
        std::all_of(parts_.begin(), parts_.end(),
                    [&](const Part& p) { return p.greatest <= few; }) &&
        std::all_of(unsure.begin(), unsure.end(), [&](auto v) { return colours_[v] <= few; });
    if (!does)
      for (const std::uint32_t v : unsure) mark_later(stale, v);
    return does;
  }

  void mark_later(std::vector<std::uint64_t>& stale, std::uint32_t v) const {
    graph_.for_each_neighbour(v, [&](std::uint32_t u) { mark(stale, u, u > v); });
  }

  /// Checks stale vertices one by one, until so many are stale that colouring the rest is faster.
  void repair(std::vector<std::uint64_t>& stale) {
    const std::uint32_t begin = window(0).end;
    std::size_t looks = 0;
    for (std::size_t word = begin / 64; word < stale.size(); ++word)
      for (; stale[word] != 0; stale[word] &= stale[word] - 1) {
        const auto v = static_cast<std::uint32_t>(64 * word) +
                       static_cast<std::uint32_t>(std::countr_zero(stale[word]));
        if (++looks > n_ / 64 + (v - begin) / 5 * 2) return colour_rest(v);
        const Word colour = colour_in_order(v);
        if (colours_[v] == colour) continue;
        colours_.set(v, colour);
        mark_later(stale, v);
      }
  }

  Word colour_in_order(std::uint32_t v) const {
    const BeforeVertex before(colours_, v);
    TakenColours<BeforeVertex<Width>> seen;
    graph_.for_each_neighbour(v, [&](std::uint32_t u) { seen.add(before[u]); });
    return least_free(graph_, v, before, seen);
  }

  void colour_rest(std::uint32_t begin) {
    colours_.fill(begin, n_, Colours<Width>::none);
    first_fit_in_order(graph_, colours_, Window{begin, static_cast<std::uint32_t>(n_)},
                       Painter{Width::marks, newest_mark}, [](std::uint32_t) {});
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  std::uint64_t n_ = graph_.vertex_count();
  std::vector<Part> parts_;
};

}  // namespace ductile::runtime::detail
