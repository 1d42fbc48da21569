/// @file
/// A parallel colouring that does not depend on threads or timing, of at most 32 blocks side by
/// side (blocks.hpp), for large graphs: many steps, and hardly any work beside first-fit.
/// A block is marked with its row's number before its step, so that a look at the colours of a
/// vertex's neighbours shows who has one that is coloured at the same time; see Words. Such a
/// vertex hides its colour until the step is over, so that it does not show earlier to some.
/// Repair is by hashed priority, see blocks.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/blocks.hpp"
#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

constexpr unsigned marked_row_bits = 5;  ///< of the greatest row's number; each has a mark

/// 17 to 32 rows, fewer of few vertices, as short blocks clash more. More steps make fewer clashes,
/// but each costs a launch.
inline BlockLayout marked_rows(std::size_t vertex_count) {
  const int bits = std::bit_width(std::max<std::size_t>(vertex_count, 1) - 1);
  const int step_bits = std::clamp(bits - 9, 3, 8);
  const int width_bits = std::clamp(bits - 7, 4, static_cast<int>(marked_row_bits));
  const int block_bits = std::max(0, bits - step_bits - width_bits);
  return {static_cast<unsigned>(block_bits), static_cast<unsigned>(step_bits)};
}

struct alignas(128) MarkedRow {
  std::vector<std::uint32_t> hiding;  ///< vertices of its last block, `waiting` for others to see
};

/// Colours all vertices of the graph.
template <class Width, Graph G>
class MarkedRun {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;
  static_assert(marks == 1U << marked_row_bits);

  MarkedRun(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        colours_(colours),
        layout_(marked_rows(colours.vertex_count())),
        rows_(layout_.row_count(colours.vertex_count())),
        hidden_(std::make_unique_for_overwrite<Word[]>(2 * rows_.size() * layout_.block_size())),
        blind_(executor) {}

  void run() {
    const auto for_each_row = [&](auto body) {
      parallel_for_ranges(executor_, rows_.size(),
                          [&](std::size_t begin, std::size_t end) {
                            for (std::size_t row = begin; row < end; ++row)
                              body(row, row + 1 < end);
                          },
                          {.grain = 1});
    };
    for_each_row([&](std::size_t row, bool) { mark(row, 0); });
    for (std::uint32_t step = 0; step < layout_.step_count(); ++step)
      for_each_row([&](std::size_t row, bool goes_on) {
        show_hidden(row, step - 1);
        // The thread that has this block is likely to have the one after it.
        colour_block(row, step, goes_on ? range(row + 1, step).first : range(row, step + 1).first);
        mark(row, step + 1);
      });
    for (std::size_t row = 0; row < rows_.size(); ++row) show_hidden(row, layout_.step_count() - 1);
    repair(executor_, as_compiled(graph_), blind_, colours_.words());
  }

  /// The colour of u as v sees it: none if it is coloured at the same time.
  Word colour_seen(std::uint32_t u, std::uint32_t v) const {
    const Word shown = colours_[u];
    if (shown <= most) return shown;
    const std::uint32_t step = layout_.step_of(v);
    if (shown != Colours<Width>::waiting) return Colours<Width>::none;
    if (layout_.step_of(u) != step) return hidden(u, step - 1);  // of which not all are shown yet
    return layout_.same_block(u, v) ? hidden(u, step) : Colours<Width>::none;
  }

 private:
  using Seen = std::conditional_t<has_many_colours<Width>, ShownBytes<Width>,
                                  TakenColours<SeenFrom<MarkedRun>>>;

  void mark(std::size_t row, std::uint32_t step) {
    if (step == layout_.step_count()) return;
    const auto [begin, end] = range(row, step);
    const Word word = Colours<Width>::mark(static_cast<std::uint32_t>(row));
    const Colours<Width> colours = colours_;
    for (std::uint32_t v = begin; v < end; ++v) colours.set(v, word);
  }

  void show_hidden(std::size_t row, std::uint32_t step) {
    for (const std::uint32_t v : rows_[row].hiding) colours_.set(v, hidden(v, step));
    rows_[row].hiding.clear();
  }

  /// `next` is the vertex that comes after the block.
  void colour_block(std::size_t row, std::uint32_t step, std::uint32_t next) {
    const auto [begin, end] = range(row, step);
    // Copies, which the compiler keeps in registers across the calls in the loop.
    const auto& rows = in_registers(graph_);
    const Colours<Width> colours = colours_;
    const VertexSet all{colours.vertex_count()};
    const auto number = static_cast<std::uint32_t>(row);
    for (std::uint32_t v = begin; v < end; ++v) {
      prefetch_after(rows, all, v + prefetch_distance_of<G>() < end ? v : next - (end - v));
      if (wants_one_look(rows, v)) {
        colour_with_care(v, step);
        continue;
      }
      TakenColours<Colours<Width>> seen;
      visit_in_pairs(rows, v, [&](std::uint32_t u) { seen.add(colours[u]); });
      if (seen.shows_others(number)) [[unlikely]] {
        colour_with_care(v, step);
      } else {
        colours.set(v, least_free(rows, v, colours, seen));
      }
    }
  }

  /// Whether v has so many neighbours that a look without care would likely have to be repeated.
  static bool wants_one_look(const auto& rows, std::uint32_t v) {
    if constexpr (RowGraph<G> && has_many_colours<Width>) {
      return rows.row(v).size() >= many_neighbours;
    } else {
      return false;
    }
  }

  /// Colours v, of whose neighbours some may be coloured at the same time, or have a hidden colour.
  /// Not inlined, so as to keep the caller's loop tight.
  [[gnu::noinline]] void colour_with_care(std::uint32_t v, std::uint32_t step) {
    const auto& rows = in_registers(graph_);
    const Colours<Width> colours = colours_;
    Seen seen;
    bool hides = false;
    visit_in_pairs(rows, v, [&](std::uint32_t u) {
      const Word shown = colours[u];
      seen.add(shown);
      if (static_cast<Word>(shown + 1) > most + 1) [[unlikely]]  // neither a colour nor `none`
        seen.add(look_closer(u, v, step, hides));
    });
    const Word colour = least_free_of(v, seen);
    if (hides) {
      hidden(v, step) = colour;
      rows_[layout_.row_of(v)].hiding.push_back(v);
    }
    colours_.set(v, hides ? Colours<Width>::waiting : colour);
  }

  /// What v, which has its turn in this step, sees of u, which shows no colour. Sets `hides` if
  /// they are coloured at the same time, and lists them.
  [[gnu::noinline]] Word look_closer(std::uint32_t u, std::uint32_t v, std::uint32_t step,
                                     bool& hides) {
    if (layout_.step_of(u) != step || layout_.same_block(u, v)) return colour_seen(u, v);
    hides = true;
    if (u < v) blind_.mine().emplace_back(u, v);  // one of the two notes it
    return Colours<Width>::none;
  }

  Word least_free_of(std::uint32_t v, const Seen& seen) const {
    if constexpr (has_many_colours<Width>) {
      return seen.least_free();
    } else {
      return least_free(graph_, v, SeenFrom(*this, v), seen);
    }
  }

  /// Where v, which has its turn in this step, hides its colour, until the next step is over.
  Word& hidden(std::uint32_t v, std::uint32_t step) const {
    const std::size_t row = layout_.row_of(v) + (step % 2) * rows_.size();
    return hidden_[(row << layout_.block_bits) + (v & (layout_.block_size() - 1))];
  }

  /// The vertices of the row's block that has its turn; after the last step, none.
  std::pair<std::uint32_t, std::uint32_t> range(std::size_t row, std::uint32_t step) const {
    const std::size_t n = colours_.vertex_count(), size = layout_.block_size();
    const std::size_t begin =
        step == layout_.step_count() ? n : std::min(layout_.block_of(row, step) * size, n);
    return {static_cast<std::uint32_t>(begin),
            static_cast<std::uint32_t>(std::min(begin + size, n))};
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  BlockLayout layout_;
  std::vector<MarkedRow> rows_;
  std::unique_ptr<Word[]> hidden_;  // [odd or even step][row][place in block]
  BlindPairs blind_;
};

struct MarkedBlocks {
  static constexpr std::uint32_t marks = 1U << marked_row_bits;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> colours) {
    MarkedRun<Width, G>(executor, graph, colours).run();
  }
};

}  // namespace ductile::runtime::detail
