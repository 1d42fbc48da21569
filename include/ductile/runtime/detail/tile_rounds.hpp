/// @file
/// TileRounds: the strategy `tiles`. Each round cuts its work into tiles; one thread plans and
/// applies the items of a tile one by one while their data are in its cache, and keeps no plan.
/// Each tile has one of 32 ranks; of two conflicting items, the one whose tile has the lower rank
/// comes first, see ranked_blocks.hpp. The few items with an earlier neighbour in another tile of
/// the same rank are late, which avoids long chains of waiting tiles. Late, postponed, and late-
/// woken items are the next round's work. All conflicts are read before any item runs, so they may
/// change meanwhile; with `keeps_conflicts`, a tile's only when it begins. Neighbouring items
/// should be close in the work.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/ranked_blocks.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/detail/woken_items.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// The turns of items as numbers: the rank of the tile in the high bits, then the place in the
/// work. Comparing numbers tells which item comes first, and in which tile.
struct Turns {
  static constexpr unsigned rank_bits = 5, place_bits = 32 - rank_bits;
  static constexpr std::uint32_t most_items = (1U << place_bits) - 1;

  static std::uint32_t at(std::uint32_t rank, std::size_t place) {
    return rank << place_bits | static_cast<std::uint32_t>(place);
  }
  static std::uint32_t place_of(std::uint32_t turn) { return turn & most_items; }
};

template <ConflictingOperator Op>
class Tiles {
 public:
  using Item = std::uint32_t;

  /// Reads the conflicts of at most Turns::most_items items and sets their turns. The arguments
  /// outlive this object. Throws std::invalid_argument if an item is in the work twice.
  Tiles(const Executor& executor, Op& op, std::span<const Item> work, WokenItems& woken)
      : op_(op),
        work_(work),
        woken_(woken),
        turn_of_(woken.turns().data()),
        layout_(layout_of(work.size())),
        tiles_(executor, tile_count(), [&](std::size_t tile) { return rank_of(tile); }),
        is_late_(std::make_unique_for_overwrite<bool[]>(work.size())),
        range_of_(tile_count()),
        counts_of_(tile_count()),
        met_(executor) {
    parallel_for(
        executor, work.size(),
        [&](std::size_t place) {
          std::atomic_ref(turn_of_[work_[place]]).store(turn_at(place), std::memory_order_relaxed);
        },
        few_nanoseconds);
    if (!conflicts_stay)
      parallel_for(executor, tile_count(), [&](std::size_t tile) { survey(tile); },
                   {.grain = 1, .serial_below = few_to_survey >> layout_.block_bits});
  }

  /// Plans and applies the items except late and postponed ones; brings back the late ones.
  void run() {
    const auto advance = [&](Begun& begun) {
      const std::size_t before = first_before(begun);
      if (before == none) run_items(begun.tile);
      return before;
    };
    const auto begin = [&](std::size_t tile) {
      if (conflicts_stay) survey(tile);
      return Begun{tile};
    };
    tiles_.run(begin, advance);
  }

  struct Counts {
    std::size_t planned = 0, applied = 0;
  };
  Counts counts() const {
    Counts sum;
    for (const Counts& counts : counts_of_)
      sum = {sum.planned + counts.planned, sum.applied + counts.applied};
    return sum;
  }

 private:
  static constexpr bool conflicts_stay = requires { Op::keeps_conflicts; };

  /// A tile that a thread has begun, and how many of those it waits for are known to be done.
  struct Begun {
    std::size_t tile;
    std::size_t seen = 0;
  };
  using Ranked = RankedBlocks<Begun>;
  static constexpr std::size_t none = Ranked::none;
  /// Items between two stages of prefetching.
  static constexpr std::size_t ahead = 3;
  /// Number of items surveyed faster than other threads would start.
  static constexpr std::size_t few_to_survey = 16;

  /// The tiles that a thread's tiles wait for, one list after the other.
  struct Met {
    std::vector<std::uint32_t> tiles;
    std::vector<std::uint32_t> last_of;  // [tile], the last one it was recorded for
  };
  struct Range {
    std::uint32_t thread, begin, end;  // in the thread's list
  };

  /// At least 512 tiles if there are as many pairs of items: few items in long tiles would wait for
  /// each other in a chain, and so would tiles longer than 64.
  static BlockLayout layout_of(std::size_t items) {
    const int bits = std::clamp(static_cast<int>(std::bit_width(items)) - 11, 1, 6);
    return {static_cast<unsigned>(bits), Turns::rank_bits};
  }
  std::size_t tile_count() const {
    return (work_.size() + layout_.block_size() - 1) >> layout_.block_bits;
  }
  std::uint8_t rank_of(std::size_t tile) const { return layout_.rank_of(tile); }
  std::size_t first_place(std::size_t tile) const { return tile << layout_.block_bits; }
  std::uint32_t turn_at(std::size_t place) const {
    return Turns::at(rank_of(place >> layout_.block_bits), place);
  }
  std::span<const Item> items_of(std::size_t tile) const {
    const std::size_t begin = first_place(tile);
    return work_.subspan(begin, std::min(layout_.block_size(), work_.size() - begin));
  }

  /// Finds a tile's late items and the tiles of lower rank that it touches.
  void survey(std::size_t tile) {
    const std::span<const Item> items = items_of(tile);
    Met& met = met_.mine();
    met.last_of.resize(tile_count(), WokenItems::absent);
    const auto begin = static_cast<std::uint32_t>(met.tiles.size());
    for (std::size_t i = 0; i < items.size() + 2 * ahead; ++i) {
      if (i < items.size()) prefetch_item(op_, items[i], 2);
      if (i - ahead < items.size()) prefetch_item(op_, items[i - ahead], 1);
      if (i >= 2 * ahead) look(first_place(tile) + i - 2 * ahead, tile, met);
    }
    counts_of_[tile] = {};
    range_of_[tile] = {static_cast<std::uint32_t>(this_thread()), begin,
                       static_cast<std::uint32_t>(met.tiles.size())};
  }

  /// Finds whether the item at this place is late, and the tiles of lower rank that it touches.
  /// Branch-free for each neighbour, because branches would be unpredictable.
  void look(std::size_t place, std::size_t tile, Met& met) const {
    const Item item = work_[place];
    if (turn_of_[item] != turn_at(place)) throw_twice(item);
    const std::uint32_t first_of_tile = turn_at(first_place(tile));
    const std::uint32_t first_of_rank = Turns::at(rank_of(tile), 0);
    std::array<std::uint32_t, 256> lower;
    std::size_t count = 0;
    unsigned late = 0;
    op_.conflicts(item, [&](Item other) {
      const std::uint32_t turn = turn_of_[other];
      late |= static_cast<unsigned>(turn - first_of_rank < first_of_tile - first_of_rank);
      lower[count] = turn;
      count += static_cast<std::size_t>(turn < first_of_rank);
      if (count == lower.size()) [[unlikely]]
        note(tile, std::span(lower).first(std::exchange(count, 0)), met);
    });
    note(tile, std::span(lower).first(count), met);
    is_late_[place] = late != 0;
  }

  void note(std::size_t tile, std::span<const std::uint32_t> turns, Met& met) const {
    for (const std::uint32_t turn : turns) {
      const std::uint32_t other = Turns::place_of(turn) >> layout_.block_bits;
      if (std::exchange(met.last_of[other], static_cast<std::uint32_t>(tile)) != tile)
        met.tiles.push_back(other);
    }
  }

  std::span<const std::uint32_t> waits_of(std::size_t tile) const {
    const Range& range = range_of_[tile];
    return std::span(met_[range.thread].tiles).subspan(range.begin, range.end - range.begin);
  }

  /// A tile that this one must wait for; none if all are done.
  std::size_t first_before(Begun& begun) {
    const std::span<const std::uint32_t> waits = waits_of(begun.tile);
    for (; begun.seen < waits.size(); ++begun.seen)
      if (tiles_.comes_before(waits[begun.seen], rank_of(begun.tile))) return waits[begun.seen];
    return none;
  }

  /// Prefetches only for items that run: data of an item that has left the round may change
  /// concurrently.
  void run_items(std::size_t tile) {
    const std::span<const Item> items = items_of(tile);
    const bool* const late = is_late_.get() + first_place(tile);
    const auto runs = [&](std::size_t i) {
      return i < items.size() && !late[i] && !woken_.is_postponed(items[i]);
    };
    typename Op::Plan plan{};
    ReachAll reach;
    auto commit = woken_.commit();
    Counts& counts = counts_of_[tile];
    for (std::size_t i = 0; i < items.size() + 3 * ahead; ++i) {
      for (const int stage : {2, 1, 0}) {
        const std::size_t asked = i - static_cast<std::size_t>(2 - stage) * ahead;
        if (runs(asked)) prefetch_item(op_, items[asked], stage);
      }
      const std::size_t now = i - 3 * ahead;
      if (now >= items.size()) continue;
      if (late[now]) woken_.bring_back(items[now]);
      if (!runs(now)) continue;
      ++counts.planned;
      if (!std::as_const(op_).plan(items[now], plan, reach)) continue;
      ++counts.applied;
      commit.turn = turn_at(first_place(tile) + now);
      op_.apply(items[now], plan, commit);
    }
  }

  Op& op_;
  std::span<const Item> work_;
  WokenItems& woken_;
  std::uint32_t* turn_of_;  // [item]
  BlockLayout layout_;
  Ranked tiles_;
  std::unique_ptr<bool[]> is_late_;  // [place]
  UnsetVector<Range> range_of_;      // [tile], the tiles it waits for
  UnsetVector<Counts> counts_of_;    // [tile]
  PerThread<Met> met_;
};

template <ConflictingOperator Op>
class TileRounds {
 public:
  using Item = std::uint32_t;

  TileRounds(const Executor& executor, Op& op)
      : executor_(executor), op_(op), woken_(executor, op.resource_count()) {}

  /// Work has size() and operator[].
  RoundsReport run(const auto& work, std::size_t most_rounds) {
    UnsetVector<Item> next = known_items(executor_, work, woken_.turns().size());
    while (!next.empty() && report_.rounds < most_rounds) next = run_round(next);
    report_.left = next.size();
    return report_;
  }

 private:
  UnsetVector<Item> run_round(std::span<const Item> all) {
    ++report_.rounds;
    ++report_.batches;
    woken_.begin_round();
    const auto work = all.first(std::min<std::size_t>(all.size(), Turns::most_items));
    run_tiles(work);
    const PhaseTimer timer(report_.wake_seconds);
    parallel_for(
        executor_, work.size(),
        [&](std::size_t i) { woken_.turns()[work[i]] = WokenItems::absent; }, few_nanoseconds);
    for (const Item item : all.subspan(work.size())) woken_.bring_back(item);
    return woken_.take();
  }

  void run_tiles(std::span<const Item> work) {
    std::optional<Tiles<Op>> tiles;
    {
      const PhaseTimer timer(report_.conflict_seconds);
      tiles.emplace(executor_, op_, work, woken_);
    }
    const PhaseTimer timer(report_.apply_seconds);
    tiles->run();
    const auto [planned, applied] = tiles->counts();
    report_.planned += planned;
    report_.applied += applied;
    report_.lost += work.size() - planned;
  }

  const Executor& executor_;
  Op& op_;
  WokenItems woken_;
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
