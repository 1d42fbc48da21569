/// @file
/// Tiles: stretches of items, in each of which one thread plans and applies one after the other
/// while what they touch is in its cache; nothing is coloured and no plan is kept. Each tile has
/// one of 16 ranks (steps of blocks.hpp), and of neighbours the one whose tile has the lower rank
/// comes first. Threads take tiles as they lie side by side. One that meets a neighbour of a tile
/// of lower rank that is not done does that tile first, or waits until the thread that has begun it
/// is done. As ranks fall from each tile to the one it waits for, nobody waits for himself. Few
/// items have an earlier neighbour in another tile of the same rank; they are left for the classes
/// of a coloured round, lest tiles wait for each other in long chains.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <numeric>
#include <optional>
#include <span>
#include <thread>
#include <type_traits>
#include <vector>

#include "ductile/runtime/detail/blocked_colouring.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/filled_array.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/recording.hpp"

namespace ductile::runtime::detail {

/// Tiles of 32 to 128 items.
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
        rank_of_((op.item_count() >> layout_.block_bits) + 1),
        claimed_(rank_of_.size()),
        applied_of_(rank_of_.size()),
        left_(executor, work.size()),
        begun_(executor),
        recording_(executor.recording()) {
    // Loops that run inside another, or on one thread, are not recorded as loops.
    if (executor.threads() == 1 || (recording_ != nullptr && recording_->in_loop()))
      recording_ = nullptr;
    parallel_for(executor_, rank_of_.size(),
                 [&](std::size_t tile) { rank_of_[tile] = first_rank_of(tile); },
                 {.serial_below = 4096});
    if (recording_ != nullptr) recording_->aside([&] { number_parts(); });
  }

  /// Plans and applies all items but those that are left, each with a commit of its tile; tells
  /// planning(item) before.
  void run(auto&& new_commit, auto&& planning) {
    parallel_for(executor_, rank_of_.size(),
                 [&](std::size_t tile) { run_with_those_before(tile, new_commit, planning); },
                 {.grain = 1});
  }

  std::size_t applied() const {
    return std::accumulate(applied_of_.begin(), applied_of_.end(), std::size_t{0});
  }
  /// [position in the work], 1 if the item is left.
  const FilledArray<std::uint8_t>& left() const { return left_; }

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

  /// Steps between asking for something that an item needs and the next stage of it. Three are as
  /// long as memory takes to answer three times.
  static constexpr std::size_t ahead = 5;
  static constexpr std::uint8_t done = 0xff;  // no tile's rank
  static constexpr std::size_t none = ~std::size_t{0};

  /// If a tile ends by an exception, nobody is to wait for what will never be done.
  struct FailsIfThrown {
    std::atomic<bool>& failed;
    int exceptions = std::uncaught_exceptions();
    ~FailsIfThrown() {
      if (std::uncaught_exceptions() > exceptions) failed.store(true);
    }
  };

  /// Runs a tile unless somebody has begun it, and whichever have to come before, of which it keeps
  /// a stack: their ranks fall.
  void run_with_those_before(std::size_t tile, auto&& new_commit, auto&& planning) {
    if (!claim(tile)) return;
    const FailsIfThrown guard{failed_};
    std::vector<Begun>& begun = begun_.mine();
    begun.clear();
    begun.push_back(begin(tile, new_commit()));
    while (!begun.empty() && !failed_.load(std::memory_order_relaxed)) {
      if (recording_ != nullptr) [[unlikely]]
        recording_->begin_part(part_of_[begun.back().tile]);
      const std::size_t before = advance(begun.back(), planning);
      if (before == none) {
        std::atomic_ref(rank_of_[begun.back().tile]).store(done, std::memory_order_release);
        begun.pop_back();
      } else if (claim(before)) {
        begun.push_back(begin(before, new_commit()));
      } else {
        await(before);
      }
    }
  }

  bool claim(std::size_t tile) {
    // Relaxed: what a tile reads is ordered by the ranks of those before it.
    return std::atomic_ref(claimed_[tile]).exchange(1, std::memory_order_relaxed) == 0;
  }

  void await(std::size_t tile) {
    constexpr int spins = 1000;  // then whoever has begun it may have lost its core
    for (int tries = 0; rank_now(tile) != done && !failed_.load(); tries += tries < spins)
      if (tries == spins) std::this_thread::yield();
  }

  Begun begin(std::size_t tile, Commit<Op> commit) {
    if (recording_ != nullptr) [[unlikely]]
      recording_->begin_part(part_of_[tile]);
    const std::size_t first = position_of(tile << layout_.block_bits);
    const std::size_t end = position_of((tile + 1) << layout_.block_bits);
    Begun begun{tile, rank_now(tile), work_.subspan(first, end - first), left_.data() + first,
                std::move(commit)};
    if (recording_ != nullptr) [[unlikely]]
      record_waits(begun);
    return begun;
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
      waits |= static_cast<unsigned>(rank_now(tile_of(other)) < begun.rank);
    });
    left = is_left != 0;
    return waits == 0 ? none : first_before(item, begun.rank);
  }

  /// One of the tiles that an item waits for; none if they are done by now.
  [[gnu::noinline, gnu::cold]] std::size_t first_before(Item item, std::uint8_t rank) {
    std::size_t before = none;
    op_.conflicts(item, [&](Item other) {
      if (rank_now(tile_of(other)) < rank) before = tile_of(other);
    });
    return before;
  }

  std::size_t tile_of(Item item) const { return item >> layout_.block_bits; }
  std::uint8_t rank_now(std::size_t tile) {
    return std::atomic_ref(rank_of_[tile]).load(std::memory_order_acquire);
  }

  /// Tiles next to each other are mostly neighbours. Their ranks are far apart, as all of a row
  /// would wait in a chain if one came right after the other.
  std::uint8_t first_rank_of(std::size_t tile) const {
    const auto item = static_cast<std::uint32_t>(tile << layout_.block_bits);
    return static_cast<std::uint8_t>(7 * layout_.step_of(item) & (layout_.step_count() - 1));
  }

  // ---- Recordings: each tile is a part of the loop, and those of lower rank come first ----

  void number_parts() {
    std::vector<std::size_t> tiles(rank_of_.size());
    std::iota(tiles.begin(), tiles.end(), std::size_t{0});
    std::stable_sort(tiles.begin(), tiles.end(),
                     [&](std::size_t a, std::size_t b) { return rank_of_[a] < rank_of_[b]; });
    part_of_.resize(tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) part_of_[tiles[i]] = i;
  }

  void record_waits(const Begun& begun) {
    recording_->aside([&] {
      std::vector<std::size_t> before;
      for (const Item item : begun.items)
        op_.conflicts(item, [&](Item other) {
          const std::size_t tile = tile_of(other);
          if (first_rank_of(tile) < begun.rank) before.push_back(part_of_[tile]);
        });
      std::sort(before.begin(), before.end());
      before.erase(std::unique(before.begin(), before.end()), before.end());
      for (const std::size_t part : before) recording_->part_waits(part_of_[begun.tile], part);
    });
  }

  const Executor& executor_;
  Op& op_;
  std::span<const Item> work_;
  BlockLayout layout_;
  std::vector<std::uint8_t> rank_of_;      // [tile], or done
  std::vector<std::uint8_t> claimed_;      // [tile], by a thread that has begun it
  std::vector<std::uint32_t> applied_of_;  // [tile]
  FilledArray<std::uint8_t> left_;         // [position in the work]
  PerThread<std::vector<Begun>> begun_;    // the thread's
  std::atomic<bool> failed_{false};
  Recording* recording_;              // null but where this is what is recorded
  std::vector<std::size_t> part_of_;  // [tile], if there is a recording
};

}  // namespace ductile::runtime::detail
