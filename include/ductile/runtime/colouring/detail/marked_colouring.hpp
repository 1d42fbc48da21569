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

#include "ductile/runtime/colouring/detail/blocks.hpp"
#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/fronts.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

constexpr unsigned marked_row_bits = 5;  ///< of the greatest row's number; each has a mark
/// That of the newest vertices of all rows, see in_order.hpp. Who sees it sees its own row's: of
/// two neighbours that are coloured at the same time, the first to look sees the mark of the
/// other's row, and goes from that of its own to `waiting`, which the other sees.
constexpr std::uint32_t newest_mark = 1U << marked_row_bits;

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
  std::size_t next = 0;               ///< whose block its thread is likely to colour after its own
};

/// Colours all vertices of the graph.
template <class Width, Graph G>
class MarkedRun {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;
  static_assert(marks == newest_mark + 1);

  MarkedRun(const Executor& executor, const G& graph, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        colours_(colours),
        layout_(marked_rows(colours.vertex_count())),
        rows_(layout_.row_count(colours.vertex_count())),
        hidden_(std::make_unique_for_overwrite<Word[]>(2 * rows_.size() * layout_.block_size())),
        blind_(executor) {
    const auto threads = static_cast<std::size_t>(executor.threads());
    for (std::size_t t = 0, begin = 0; t < threads; ++t) {  // parts as a loop begins with
      const std::size_t end = rows_.size() * (t + 1) / threads;
      for (std::size_t row = begin; row < end; ++row)
        rows_[row].next = row + 1 < end ? row + 1 : begin;
      begin = end;
    }
  }

  void run() {
    const auto for_each_row = [&](auto body) {
      parallel_for(executor_, rows_.size(), body, {.grain = 1});
    };
    for_each_row([&](std::size_t row) { mark({row, 0}); });
    for (std::uint32_t step = 0; step < layout_.step_count(); ++step)
      for_each_row([&](std::size_t row) {
        show_hidden(row, step - 1);
        colour_block({row, step});
        mark({row, step + 1});
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

  /// Of a row, when its block is coloured.
  struct Turn {
    std::size_t row;
    std::uint32_t step;
  };

  void mark(const Turn& turn) {
    const Window block = block_of(turn);
    const Word word = Colours<Width>::mark(static_cast<std::uint32_t>(turn.row));
    colours_.fill(block.begin, block.end, word);
  }

  void show_hidden(std::size_t row, std::uint32_t step) {
    for (const std::uint32_t v : rows_[row].hiding) colours_.set(v, hidden(v, step));
    rows_[row].hiding.clear();
  }

  void colour_block(const Turn& turn) {
    const Window block = block_of(turn);
    if (block.size() == 0) return;
    const Turn next = after(turn);
    if constexpr (requires { graph_.prefetch_row_begins(0, 0); }) {
      const Window later = block_of(after(next));
      graph_.prefetch_row_begins(later.begin, later.end);
    }
    const auto number = static_cast<std::uint32_t>(turn.row);
    const LeavingPainter painter{{number, newest_mark}, block_of(next).begin};
    first_fit_in_order<true>(graph_, colours_, block, painter,
                             [&](std::uint32_t v) { return colour_with_care(v, turn.step); });
  }

  /// The turn that the same thread is likely to take after this one.
  Turn after(const Turn& turn) const {
    const std::size_t row = rows_[turn.row].next;
    return {row, row > turn.row ? turn.step : turn.step + 1};
  }

  /// Colours v, of whose neighbours some may be coloured at the same time, or have a hidden colour;
  /// returns what v shows then.
  /// Not inlined, so as to keep the caller's loop tight.
  [[gnu::noinline]] Word colour_with_care(std::uint32_t v, std::uint32_t step) {
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
    const Word shown = hides ? Colours<Width>::waiting : colour;
    colours.set(v, shown);
    return shown;
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

  /// The vertices of the block that has its turn; after the last step, none.
  Window block_of(const Turn& turn) const {
    const std::size_t n = colours_.vertex_count(), size = layout_.block_size();
    const bool is_over = turn.step >= layout_.step_count();
    const std::size_t begin =
        is_over ? n : std::min(layout_.block_of(turn.row, turn.step) * size, n);
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
  static constexpr std::uint32_t marks = newest_mark + 1;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet, Colours<Width> colours) {
    MarkedRun<Width, G>(executor, graph, colours).run();
  }
};

}  // namespace ductile::runtime::detail
