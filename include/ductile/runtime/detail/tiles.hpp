/// @file
/// Tiles: stretches of items, in each of which one thread plans and applies one after the other
/// while what they touch is in its cache; nothing is coloured and no plan is kept. Each tile has
/// one of 32 ranks (steps of blocks.hpp), and of neighbours the one whose tile has the lower rank
/// comes first, see ranked_blocks.hpp. Few items have an earlier neighbour in another tile of the
/// same rank; they are left, lest tiles wait for each other in long chains, and run last, in tiles
/// of their own (surveyed_tiles.hpp).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/colouring/detail/blocked_colouring.hpp"
#include "ductile/runtime/detail/ranked_blocks.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Tiles of 16 to 64 items: longer ones wait for each other in longer chains.
inline BlockLayout tiles_of(std::size_t item_count) {
  const int bits = std::clamp(static_cast<int>(std::bit_width(item_count)) - 12, 4, 6);
  return {static_cast<unsigned>(bits), 5};
}

template <SteadyTiledOperator Op>
class Tiles {
 public:
  using Item = typename Op::Item;
  static_assert(std::is_empty_v<typename Op::Update>, "tiles defer nothing");

  /// Not worth it: so few items, or so small a share of all, as each tile is looked at. Those are
  /// for SurveyedTiles.
  static bool are_few(std::size_t work, std::size_t all) { return work < 2048 || work < all / 4; }

  /// Of work in ascending order, which outlives this.
  Tiles(const Executor& executor, Op& op, std::span<const Item> work)
      : op_(op),
        work_(work),
        layout_(tiles_of(op.item_count())),
        tiles_(executor, tile_of(op.item_count()) + 1,
               [&](std::size_t tile) { return rank_of(tile); }),
        applied_of_(tile_of(op.item_count()) + 1),
        left_(make_filled<std::uint8_t>(executor, work.size())) {}

  /// Plans and applies all items but those that are left, each with a commit of its tile; tells
  /// planning(item) before.
  void run(auto&& new_commit, auto&& planning) {
    tiles_.run([&](std::size_t tile) { return begin(tile, new_commit()); },
               [&](Begun& begun) { return advance(begun, planning); });
  }

  std::size_t applied() const {
    return std::accumulate(applied_of_.begin(), applied_of_.end(), std::size_t{0});
  }
  /// [position in the work], 1 if the item is left.
  const UnsetVector<std::uint8_t>& left() const { return left_; }

 private:
  /// A tile that a thread has begun, and how far it is.
  struct Begun {
    std::size_t tile;
    std::uint8_t rank;
    std::span<const Item> items;
    std::uint8_t* left;  // of its items
    Commit<Op> commit;
    std::size_t step = 0;
  };
  using Ranked = RankedBlocks<Begun>;

  /// Steps between asking for something that an item needs and the next stage of it. Three are as
  /// long as memory takes to answer three times.
  static constexpr std::size_t ahead = 5;
  static constexpr std::size_t none = Ranked::none;

  Begun begin(std::size_t tile, Commit<Op> commit) {
    const std::span<const Item> items = items_of(tile);
    return {tile, rank_of(tile), items, left_.data() + (items.data() - work_.data()),
            std::move(commit)};
  }

  std::span<const Item> items_of(std::size_t tile) const {
    const std::size_t first = position_of(tile << layout_.block_bits);
    return work_.subspan(first, position_of((tile + 1) << layout_.block_bits) - first);
  }

  /// Where items from this one on begin.
  std::size_t position_of(std::size_t item) const {
    const auto at = std::lower_bound(work_.begin(), work_.end(), item);
    return static_cast<std::size_t>(at - work_.begin());
  }

  /// Goes on with a tile until it is done, or another has to come before: returns which, or none.
  std::size_t advance(Begun& begun, auto&& planning) {
    const std::span<const Item> items = begun.items;
    for (; begun.step < items.size() + 3 * ahead; ++begun.step) {
      const auto in_stage = [&](std::size_t stage) { return begun.step - stage * ahead; };
      if (in_stage(0) < items.size()) op_.prefetch(items[in_stage(0)], 2);
      if (in_stage(1) < items.size()) op_.prefetch(items[in_stage(1)], 1);
      if (in_stage(2) < items.size()) {
        const std::size_t before = look(items[in_stage(2)], begun, begun.left[in_stage(2)]);
        if (before != none) return before;
      }
      if (in_stage(3) >= items.size() || begun.left[in_stage(3)] != 0) continue;
      planning(items[in_stage(3)]);
      const std::optional<typename Op::Plan> plan = op_.plan(items[in_stage(3)]);
      if (!plan) continue;
      op_.apply(*plan, begun.commit);
      ++applied_of_[begun.tile];
    }
    return none;
  }

  /// Sees whether an item is left. Returns a tile that has to be done before, or none. Also asks
  /// for what planning reads of the neighbours. Without branches, as the answers cannot be
  /// foreseen.
  std::size_t look(Item item, const Begun& begun, std::uint8_t& left) {
    const Apart apart(layout_);
    unsigned is_left = 0, waits = 0;
    op_.conflicts(item, [&](Item other) {
      op_.prefetch_neighbour(other);
      is_left |= static_cast<unsigned>(other < item) & static_cast<unsigned>(apart(other, item));
      waits |= static_cast<unsigned>(tiles_.comes_before(tile_of(other), begun.rank));
    });
    left = is_left != 0;
    return waits == 0 ? none : first_before(item, begun.rank);
  }

  /// One of the tiles that an item waits for; none if they are done by now.
  [[gnu::noinline, gnu::cold]] std::size_t first_before(Item item, std::uint8_t rank) {
    std::size_t before = none;
    op_.conflicts(item, [&](Item other) {
      if (tiles_.comes_before(tile_of(other), rank)) before = tile_of(other);
    });
    return before;
  }

  std::size_t tile_of(Item item) const { return item >> layout_.block_bits; }

  std::uint8_t rank_of(std::size_t tile) const { return rank_of_block(layout_, tile); }

  Op& op_;
  std::span<const Item> work_;
  BlockLayout layout_;
  Ranked tiles_;
  std::vector<std::uint32_t> applied_of_;  // [tile]
  UnsetVector<std::uint8_t> left_;         // [position in the work]
};

}  // namespace ductile::runtime::detail
