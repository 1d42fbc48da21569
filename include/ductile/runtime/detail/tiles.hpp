/// @file
/// Tiles: stretches of items, in each of which one thread plans and applies one after the other
/// while what they touch is in its cache; nothing is coloured and no plan is kept. Tiles run in
/// steps (blocks.hpp); those of a step lie apart, so few items have a neighbour in another of them.
/// If that comes first, they wait: they are left for the classes of a coloured round.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "ductile/runtime/detail/blocked_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/make_vector.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"

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
        waits_(make_vector<std::uint8_t>(executor, work.size())),
        applied_of_(layout_.row_count(op.item_count()) << layout_.step_bits) {}

  /// Plans and applies all items that need not wait, each with a commit of its tile; tells
  /// planning(item) before.
  void run(auto&& new_commit, auto&& planning) {
    for (std::size_t step = 0; step < layout_.step_count(); ++step)
      parallel_for(
          executor_, layout_.row_count(op_.item_count()),
          [&](std::size_t row) { run_tile(layout_.block_of(row, step), new_commit, planning); },
          {.grain = 1});
  }

  std::size_t steps() const { return layout_.step_count(); }
  std::size_t applied() const {
    std::size_t sum = 0;
    for (const std::uint32_t applied : applied_of_) sum += applied;
    return sum;
  }
  /// [position in the work], 1 if the item waits.
  const std::vector<std::uint8_t>& waits() const { return waits_; }

 private:
  /// Steps between asking for something that an item needs and the next stage of it. Three are as
  /// long as memory takes to answer three times.
  static constexpr std::size_t ahead = 5;

  void run_tile(std::size_t tile, auto&& new_commit, auto&& planning) {
    const std::size_t begin = position_of(tile << layout_.block_bits);
    const std::size_t size = position_of((tile + 1) << layout_.block_bits) - begin;
    const Item* const items = work_.data() + begin;
    std::uint8_t* const waits = waits_.data() + begin;
    if (size == 0) return;
    Commit<Op> commit = new_commit();
    std::uint32_t applied = 0;
    for (std::size_t i = 0; i < size + 3 * ahead; ++i) {
      const auto in_stage = [&](std::size_t stage) { return i - stage * ahead; };
      if (in_stage(0) < size) op_.prefetch(items[in_stage(0)], 2);
      if (in_stage(1) < size) op_.prefetch(items[in_stage(1)], 1);
      if (in_stage(2) < size) waits[in_stage(2)] = has_to_wait(items[in_stage(2)]);
      if (in_stage(3) >= size || waits[in_stage(3)] != 0) continue;
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

  /// Whether an earlier neighbour may run at the same time. Also asks for what planning reads of
  /// the neighbours. Without branches, as the answer cannot be foreseen.
  bool has_to_wait(Item item) const {
    const Apart apart(layout_);
    unsigned waits = 0;
    op_.conflicts(item, [&](Item other) {
      op_.prefetch_neighbour(other);
      waits |= static_cast<unsigned>(other < item) & static_cast<unsigned>(apart(other, item));
    });
    return waits != 0;
  }

  const Executor& executor_;
  Op& op_;
  std::span<const Item> work_;
  BlockLayout layout_;
  std::vector<std::uint8_t> waits_;        // [position in the work]
  std::vector<std::uint32_t> applied_of_;  // [tile]
};

}  // namespace ductile::runtime::detail
