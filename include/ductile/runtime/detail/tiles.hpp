/// @file
/// Tiles: stretches of items, in each of which one thread plans and applies one after the other
/// while what they touch is in its cache; nothing is coloured and no plan is kept. Tiles run in
/// steps (blocks.hpp); those of a step lie apart, so few items have a neighbour in another of them.
/// If that comes first, they are left for the classes of a coloured round. Steps overlap: a tile
/// waits for those of earlier steps that it has neighbours in, and for no others.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <thread>
#include <type_traits>
#include <vector>

#include "ductile/runtime/detail/blocked_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/make_vector.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/recording.hpp"

namespace ductile::runtime::detail {

/// Tiles of 32 to 128 items, one in 16 of which run at the same time.
inline BlockLayout tiles_of(std::size_t item_count) {
  const int bits = std::clamp(static_cast<int>(std::bit_width(item_count)) - 10, 5, 7);
  return {static_cast<unsigned>(bits), 4};
}

template <TiledOperator Op>
class Tiles {
 public:
  using Item = typename Op::Item;
  static_assert(std::is_empty_v<typename Op::Update>, "tiles defer nothing");

  /// Not worth it: so few items, or so small a share of all, as each tile is looked at.
  static bool are_few(std::size_t work, std::size_t all) { return work < 2048 || work < all / 64; }

  /// Of work in ascending order, which outlives this.
  Tiles(const Executor& executor, Op& op, std::span<const Item> work)
      : executor_(executor),
        op_(op),
        work_(work),
        layout_(tiles_of(op.item_count())),
        rows_(layout_.row_count(op.item_count())),
        left_(make_vector<std::uint8_t>(executor, work.size())),
        applied_of_(rows_ << layout_.step_bits),
        done_(applied_of_.size()) {}

  /// Plans and applies all items but those that are left, each with a commit of its tile; tells
  /// planning(item) before.
  void run(auto&& new_commit, auto&& planning) {
    // This schedule begins tiles in order, so those that one waits for have begun.
    parallel_for(executor_, rows_ << layout_.step_bits,
                 [&](std::size_t turn) {
                   const std::size_t tile = layout_.block_of(turn % rows_, turn / rows_);
                   const FailsUnlessDone guard{*this, tile};
                   run_tile(tile, new_commit, planning);
                 },
                 {.grain = 1, .schedule = Schedule::omp_dynamic});
  }

  std::size_t steps() const { return layout_.step_count(); }
  std::size_t applied() const {
    std::size_t sum = 0;
    for (const std::uint32_t applied : applied_of_) sum += applied;
    return sum;
  }
  /// [position in the work], 1 if the item is left.
  const std::vector<std::uint8_t>& left() const { return left_; }

 private:
  /// Steps between asking for something that an item needs and the next stage of it. Three are as
  /// long as memory takes to answer three times.
  static constexpr std::size_t ahead = 5;

  /// At the end of a tile that many may wait for. If it ends by an exception, nobody is to wait for
  /// what will never be done.
  struct FailsUnlessDone {
    Tiles& tiles;
    std::size_t tile;
    int exceptions = std::uncaught_exceptions();
    ~FailsUnlessDone() {
      if (std::uncaught_exceptions() > exceptions) tiles.failed_.store(true);
      std::atomic_ref(tiles.done_[tile]).store(1, std::memory_order_release);
    }
  };

  void run_tile(std::size_t tile, auto&& new_commit, auto&& planning) {
    const std::size_t begin = position_of(tile << layout_.block_bits);
    const std::size_t size = position_of((tile + 1) << layout_.block_bits) - begin;
    const Item* const items = work_.data() + begin;
    std::uint8_t* const left = left_.data() + begin;
    if (size == 0) return;
    if (executor_.recording() != nullptr) record_waits({items, size});
    Commit<Op> commit = new_commit();
    std::uint32_t applied = 0;
    for (std::size_t i = 0; i < size + 3 * ahead; ++i) {
      const auto in_stage = [&](std::size_t stage) { return i - stage * ahead; };
      if (in_stage(0) < size) op_.prefetch(items[in_stage(0)], 2);
      if (in_stage(1) < size) op_.prefetch(items[in_stage(1)], 1);
      if (in_stage(2) < size) left[in_stage(2)] = is_left(items[in_stage(2)]);
      if (failed_.load(std::memory_order_relaxed)) [[unlikely]]
        return;
      if (in_stage(3) >= size || left[in_stage(3)] != 0) continue;
      planning(items[in_stage(3)]);
      const std::optional<typename Op::Plan> plan = op_.plan(items[in_stage(3)]);
      if (!plan) continue;
      op_.apply(*plan, commit);
      ++applied;
    }
    applied_of_[tile] = applied;
  }

  /// Where items from this one on begin.
  std::size_t position_of(std::size_t item) const {
    const auto at = std::lower_bound(work_.begin(), work_.end(), item);
    return static_cast<std::size_t>(at - work_.begin());
  }

  /// Whether an earlier neighbour may run at the same time; if not, all neighbours of earlier steps
  /// have had their turn afterwards. Also asks for what planning reads of the neighbours. Without
  /// branches, as the answer cannot be foreseen.
  bool is_left(Item item) {
    const Apart apart(layout_);
    const std::uint32_t step = layout_.step_of(item);
    unsigned left = 0, pending = 0;
    op_.conflicts(item, [&](Item other) {
      op_.prefetch_neighbour(other);
      left |= static_cast<unsigned>(other < item) & static_cast<unsigned>(apart(other, item));
      pending |= static_cast<unsigned>(layout_.step_of(other) < step) &
                 static_cast<unsigned>(!is_done(tile_of(other)));
    });
    if (pending != 0) [[unlikely]]
      await_neighbours(item);
    return left != 0;
  }

  /// Waits until neighbours of earlier steps have had their turn, or a tile has failed.
  [[gnu::noinline, gnu::cold]] void await_neighbours(Item item) {
    const std::uint32_t step = layout_.step_of(item);
    op_.conflicts(item, [&](Item other) {
      if (layout_.step_of(other) >= step) return;
      for (int tries = 0; !is_done(tile_of(other)) && !failed_.load(); ++tries)
        if (tries > 1000) std::this_thread::yield();  // who is to be done may have lost its core
    });
  }

  std::size_t tile_of(Item item) const { return item >> layout_.block_bits; }
  bool is_done(std::size_t tile) {
    return std::atomic_ref(done_[tile]).load(std::memory_order_acquire) != 0;
  }

  /// Tells the recording which tiles the one with these items waits for.
  void record_waits(std::span<const Item> items) const {
    executor_.recording()->aside([&] {
      std::vector<std::size_t> turns;
      const std::uint32_t step = layout_.step_of(items.front());
      for (const Item item : items)
        op_.conflicts(item, [&](Item other) {
          if (layout_.step_of(other) < step)
            turns.push_back(layout_.step_of(other) * rows_ + layout_.row_of(other));
        });
      std::sort(turns.begin(), turns.end());
      turns.erase(std::unique(turns.begin(), turns.end()), turns.end());
      for (const std::size_t turn : turns) executor_.recording()->wait_for(turn);
    });
  }

  const Executor& executor_;
  Op& op_;
  std::span<const Item> work_;
  BlockLayout layout_;
  std::size_t rows_;
  std::vector<std::uint8_t> left_;         // [position in the work]
  std::vector<std::uint32_t> applied_of_;  // [tile]
  std::vector<std::uint8_t> done_;         // [tile]
  std::atomic<bool> failed_{false};
};

}  // namespace ductile::runtime::detail
