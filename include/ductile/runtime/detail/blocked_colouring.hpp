/// @file
/// A parallel colouring that does not depend on threads or timing.
/// The ids are cut into rows of blocks; of every row one block is coloured in a step, by first-fit
/// in order, seeing the colours of earlier steps and its own. A vertex with a neighbour in another
/// block of the step is rare, the more so as a step is a small part of all. It hides its colour
/// until the step is over, and its pairs are noted: those that turn out to have one colour are
/// repaired after the last step, by hashed priority, see priority_colouring.hpp.
/// A block is marked with its row's number before its step, so that a look at the colours of a
/// vertex's neighbours shows who has such a neighbour; see WithMarks.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/first_fit.hpp"
#include "ductile/runtime/detail/priority_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/graph.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

/// How ids are cut: vertex v is in block v >> block_bits; 2^step_bits blocks make a row, which are
/// coloured in different steps, in an order that changes from row to row: where the bits of ids
/// have a meaning, equal low bits would gather related blocks in one step.
struct BlockLayout {
  static constexpr unsigned row_bits = 5;  ///< of the greatest row's number; each has a mark

  unsigned block_bits, step_bits;

  /// 17 to 32 rows, fewer of few vertices, as short blocks clash more. More steps make fewer
  /// clashes, but each costs a launch.
  static BlockLayout of(std::size_t vertex_count) {
    const int bits = std::bit_width(std::max<std::size_t>(vertex_count, 1) - 1);
    const int step_bits = std::clamp(bits - 9, bits > 11 ? 4 : 3, 8);
    const int width_bits = std::clamp(bits - 7, 4, static_cast<int>(row_bits));
    const int block_bits = std::max(0, bits - step_bits - width_bits);
    return {static_cast<unsigned>(block_bits), static_cast<unsigned>(step_bits)};
  }
  std::uint32_t step_count() const { return 1U << step_bits; }
  std::size_t block_size() const { return std::size_t{1} << block_bits; }
  std::size_t row_count(std::size_t vertex_count) const {
    const unsigned bits = block_bits + step_bits;
    return (vertex_count + (std::size_t{1} << bits) - 1) >> bits;
  }
  /// The block of this row that has its turn in this step. A block's step is its number in the
  /// row, exclusive-or the row.
  std::size_t block_of(std::size_t row, std::size_t step) const {
    return (row << step_bits) + ((step ^ row) & (step_count() - 1));
  }
  std::uint32_t row_of(std::uint32_t v) const { return v >> (block_bits + step_bits); }
  std::uint32_t step_of(std::uint32_t v) const {
    return ((v >> block_bits) ^ row_of(v)) & (step_count() - 1);
  }
  bool same_block(std::uint32_t u, std::uint32_t v) const { return (u ^ v) >> block_bits == 0; }
};

/// The colours, but those of vertices that get theirs at the same time as v.
template <class Run>
class SeenFrom {
 public:
  using Word = typename Run::Word;
  static constexpr Word most = Run::most;
  static constexpr std::uint32_t marks = Run::marks;

  SeenFrom(const Run& run, std::uint32_t v) : run_(&run), v_(v) {}
  Word operator[](std::uint32_t u) const { return run_->colour_seen(u, v_); }

 private:
  const Run* run_;
  std::uint32_t v_;
};

template <class Width, Graph G>
class BlockedRun {
 public:
  using Word = typename Width::Word;
  static constexpr Word most = Width::most;
  static constexpr std::uint32_t marks = Width::marks;
  static_assert(marks == 1U << BlockLayout::row_bits);

  BlockedRun(const Executor& executor, const G& graph, VertexSet vertices, Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        vertices_(vertices),
        colours_(colours),
        layout_(BlockLayout::of(colours.vertex_count())),
        rows_(layout_.row_count(colours.vertex_count())),
        hidden_(std::make_unique_for_overwrite<Word[]>(2 * rows_.size() * layout_.block_size())),
        blind_(executor) {
    if (vertices_.list != nullptr) find_blocks();
  }

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
    colour_by_priority(executor_, graph_, losers(), colours_, outranks);
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
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  struct alignas(128) Row {
    std::vector<std::uint32_t> hiding;  // vertices of its last block, `waiting` for others to see
  };

  void mark(std::size_t row, std::uint32_t step) {
    if (step == layout_.step_count()) return;
    const auto [begin, end] = range(row, step);
    const Word word = Colours<Width>::mark(static_cast<std::uint32_t>(row));
    const Colours<Width> colours = colours_;
    const VertexSet vertices = vertices_;
    for (std::size_t i = begin; i < end; ++i) colours.set(vertices[i], word);
  }

  void show_hidden(std::size_t row, std::uint32_t step) {
    for (const std::uint32_t v : rows_[row].hiding) colours_.set(v, hidden(v, step));
    rows_[row].hiding.clear();
  }

  /// `next` is the position of the vertex that comes after the block.
  void colour_block(std::size_t row, std::uint32_t step, std::size_t next) {
    const auto [begin, end] = range(row, step);
    // Copies, which the compiler keeps in registers across the calls in the loop.
    const auto& rows = in_registers(graph_);
    const Colours<Width> colours = colours_;
    const VertexSet vertices = vertices_;
    const auto number = static_cast<std::uint32_t>(row);
    for (std::size_t i = begin; i < end; ++i) {
      prefetch_after(rows, vertices, i + prefetch_distance < end ? i : next - (end - i));
      const std::uint32_t v = vertices[i];
      TakenColours<Colours<Width>> seen;
      rows.for_each_neighbour(v, [&](std::uint32_t u) { seen.add(colours[u]); });
      if (seen.shows_others(number)) [[unlikely]] {
        colour_with_care(v, step);
      } else {
        colours.set(v, least_free(rows, v, colours, seen));
      }
    }
  }

  /// Colours v, of whose neighbours one may be coloured at the same time, or have a hidden colour.
  /// Not inlined, so as to keep the caller's loop tight.
  [[gnu::noinline]] void colour_with_care(std::uint32_t v, std::uint32_t step) {
    bool hides = false;
    TakenColours<SeenFrom<BlockedRun>> seen;
    graph_.for_each_neighbour(v, [&](std::uint32_t u) {
      const Word shown = colours_[u];
      if (shown <= most || shown == Colours<Width>::none) return seen.add(shown);
      if (layout_.step_of(u) != step || layout_.same_block(u, v))
        return seen.add(colour_seen(u, v));
      hides = true;
      if (u < v) blind_.mine().emplace_back(u, v);  // one of the two notes it
    });
    const Word colour = least_free(graph_, v, SeenFrom(*this, v), seen);
    if (hides) {
      hidden(v, step) = colour;
      rows_[layout_.row_of(v)].hiding.push_back(v);
    }
    colours_.set(v, hides ? Colours<Width>::waiting : colour);
  }

  /// Where v, which has its turn in this step, hides its colour, until the next step is over.
  Word& hidden(std::uint32_t v, std::uint32_t step) const {
    const std::size_t row = layout_.row_of(v) + (step % 2) * rows_.size();
    return hidden_[(row << layout_.block_bits) + (v & (layout_.block_size() - 1))];
  }

  /// The positions in vertices_ of those of the block that has its turn; after the last step, of
  /// none.
  std::pair<std::size_t, std::size_t> range(std::size_t row, std::uint32_t step) const {
    if (step == layout_.step_count()) return {vertices_.count, vertices_.count};
    const std::size_t block = layout_.block_of(row, step);
    if (vertices_.list != nullptr) return {begin_of_[block], begin_of_[block + 1]};
    const std::size_t size = layout_.block_size();
    return {std::min(block * size, vertices_.count), std::min((block + 1) * size, vertices_.count)};
  }

  void find_blocks() {
    begin_of_.resize((rows_.size() << layout_.step_bits) + 1);
    const std::span list(vertices_.list, vertices_.count);
    for (std::size_t block = 0; block < begin_of_.size(); ++block) {
      const auto first = std::lower_bound(list.begin(), list.end(), block << layout_.block_bits);
      begin_of_[block] = static_cast<std::size_t>(first - list.begin());
    }
  }

  /// Those whose colour is also that of a neighbour that outranks them, ascending.
  std::vector<std::uint32_t> losers() {
    std::vector<std::span<const Pair>> parts;
    for (std::size_t t = 0; t < blind_.size(); ++t)
      for (std::span<const Pair> left = blind_[t]; !left.empty();) {
        parts.push_back(left.first(std::min<std::size_t>(left.size(), 256)));
        left = left.subspan(parts.back().size());
      }
    Worklist<std::uint32_t> lost(executor_, {.unique = true});
    parallel_for(executor_, parts.size(),
                 [&](std::size_t p) {
                   for (const auto& [u, v] : parts[p])
                     if (colours_[u] == colours_[v]) lost.append(outranks(u, v) ? v : u);
                 },
                 {.grain = 1, .serial_below = 4});
    lost.collect();
    return lost.take();
  }

  const Executor& executor_;
  const G& graph_;
  VertexSet vertices_;
  Colours<Width> colours_;
  BlockLayout layout_;
  std::vector<Row> rows_;
  std::vector<std::size_t> begin_of_;   // [block], and the end: positions in the list, if there is
  std::unique_ptr<Word[]> hidden_;      // [odd or even step][row][place in block]
  PerThread<std::vector<Pair>> blind_;  // neighbours coloured at the same time
};

struct Blocked {
  static constexpr std::uint32_t marks = 1U << BlockLayout::row_bits;

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Width> colours) {
    BlockedRun<Width, G>(executor, graph, vertices, colours).run();
  }
};

}  // namespace ductile::runtime::detail
