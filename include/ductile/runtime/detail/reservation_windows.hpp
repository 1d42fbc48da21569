/// @file
/// ReservationWindows: runs windows of the work on several threads. All items of a window are
/// planned at once; an item with a plan reserves what it has reached, the lowest key wins, and
/// items that hold all they have reached are applied. The caller decides what becomes of the
/// losers. Keys follow the order of the window, or priorities.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::detail {

template <Operator Op, bool by_priority = false>
class ReservationWindows {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  static constexpr std::uint32_t nobody = 0xffffffffU;  ///< holds a resource that no item has
                                                        ///< reached
  static constexpr std::size_t most_items = 8192;       ///< in a window

  /// Keys fall from `highest_key` and restart there when used up. It is at least most_items.
  ReservationWindows(const Executor& executor, Op& op, RoundsReport& report,
                     std::uint32_t highest_key = nobody)
      : executor_(executor),
        op_(op),
        report_(report),
        made_(op),
        highest_key_(highest_key),
        blocks_(most_items / block_size) {}

  /// Runs a window of the items item_at(i), i < count. Then calls won(item, woken) for the applied
  /// items, with those that they woke, and lost(item) for those that did not get all they had
  /// reached, in the order of the window. Items without a plan are done.
  void run(std::size_t count, auto&& item_at, auto&& won, auto&& lost) {
    ++report_.batches;
    report_.planned += count;
    begin_window(count, item_at);
    const std::size_t size = std::max(least_block_size, (count - 1) / blocks_.size() + 1);
    const auto blocks = std::span(blocks_).first((count - 1) / size + 1);
    {
      const PhaseTimer timer(report_.plan_seconds);
      parallel_for_blocks(executor_, count, size,
                          [&](std::size_t block, std::size_t begin, std::size_t end) {
                            plan(blocks[block], {begin, end, count}, item_at);
                          });
    }
    const PhaseTimer timer(report_.apply_seconds);
    apply_winners(blocks, item_at);
    for (Block& block : blocks) end_block(block, item_at, won, lost);
  }

  /// Ends the run of an operator that makes things.
  void close_holes() { made_.close_holes(); }

 private:
  static constexpr bool makes_things = kinds_made<Op> != 0;
  static constexpr std::size_t block_size = 64, least_block_size = 16;

  /// An item with a plan. Ends are those of its part of the block's lists; the previous one's end
  /// is the beginning.
  struct Candidate {
    Plan plan{};
    typename MadeThings<Op>::New fresh;
    std::uint32_t number = 0;  // in the window
    std::uint32_t reached_end = 0, woken_end = 0;
    bool has_won = false;
  };
  /// A part of a window. The first `count` candidates count; the others keep their memory.
  struct alignas(128) Block {
    std::vector<Candidate> candidates;
    std::vector<std::uint32_t> reached;
    std::vector<Item> woken;
    std::size_t count = 0;

    std::span<Candidate> planned() { return std::span(candidates).first(count); }
  };
  /// The items of a block, and the number of all in the window.
  struct Part {
    std::size_t begin, end, count;
  };

  struct BlockCommit {
    Block& block;
    Candidate& candidate;
    void wake(const Item& item) { block.woken.push_back(item); }
    void postpone(const Item& item) { wake(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(makes_things) {
      return candidate.fresh.take(kind);
    }
  };

  /// Keys fall from window to window, so that reservations of earlier windows do not count.
  void begin_window(std::size_t count, auto&& item_at) {
    if constexpr (by_priority) rank(count, item_at);
    if (first_key_ < count) {
      std::fill(holder_of_.begin(), holder_of_.end(), nobody);
      first_key_ = highest_key_;
    }
    first_key_ -= static_cast<std::uint32_t>(count);
    holder_of_.resize(std::max(holder_of_.size(), op_.resource_count()), nobody);
  }

  /// Ranks the window's items by priority; of equal ones, the first in the work comes first.
  void rank(std::size_t count, auto&& item_at) {
    by_priority_.resize(count);
    rank_of_.resize(count);
    parallel_for(
        executor_, count,
        [&](std::size_t i) {
          by_priority_[i] = std::uint64_t{op_.priority(item_at(i))} << 32U | i;
        },
        few_nanoseconds);
    parallel_sort(executor_, std::span(by_priority_));
    parallel_for(
        executor_, count,
        [&](std::size_t rank) {
          rank_of_[by_priority_[rank] & 0xffffffffU] = static_cast<std::uint32_t>(rank);
        },
        few_nanoseconds);
  }

  std::uint32_t key_of(std::size_t i) const {
    if constexpr (by_priority) {
      return first_key_ + rank_of_[i];
    } else {
      return first_key_ + static_cast<std::uint32_t>(i);
    }
  }

  /// Latency of memory is about the time of planning two items.
  void prefetch_after(std::size_t i, std::size_t count, auto&& item_at) const {
    if constexpr (PrefetchingOperator<Op>)
      for (const int stage : {2, 1, 0}) {
        const std::size_t ahead = i + 2 * (static_cast<std::size_t>(stage) + 1);
        if (ahead < count) op_.prefetch(item_at(ahead), stage);
      }
  }

  void plan(Block& block, const Part& part, auto&& item_at) {
    block.reached.clear();
    block.woken.clear();
    block.count = 0;
    ReachToNote reach{block.reached};
    for (std::size_t i = part.begin; i < part.end; ++i) {
      prefetch_after(i, part.count, item_at);
      if (block.count == block.candidates.size()) block.candidates.emplace_back();
      Candidate& candidate = block.candidates[block.count];
      const std::size_t first = block.reached.size();
      if (!op_.plan(item_at(i), candidate.plan, reach)) {
        block.reached.resize(first);
        continue;
      }
      candidate.number = static_cast<std::uint32_t>(i);
      candidate.reached_end = static_cast<std::uint32_t>(block.reached.size());
      for (std::size_t r = first; r < block.reached.size(); ++r)
        reserve(holder_of_[block.reached[r]], key_of(i));
      ++block.count;
    }
  }
  void reserve(std::uint32_t& holder, std::uint32_t key) const {
    if (executor_.threads() > 1) {
      atomic_min(holder, key);
    } else {
      holder = std::min(holder, key);
    }
  }

  void apply_winners(std::span<Block> blocks, auto&& item_at) {
    const auto in_each = [&](auto&& work) {
      parallel_for(executor_, blocks.size(), [&](std::size_t b) { work(blocks[b]); }, {.grain = 1});
    };
    const auto apply_to = [&](Block& block) { apply(block, item_at); };
    if constexpr (makes_things) {
      in_each([&](Block& block) { settle(block); });
      made_.number([&](auto&& number) {
        for (Block& block : blocks)
          for (Candidate& candidate : block.planned())
            if (candidate.has_won) number(candidate);
      });
      in_each(apply_to);
    } else {
      in_each([&](Block& block) {
        settle(block);
        apply_to(block);
      });
    }
  }

  void settle(Block& block) const {
    std::size_t first = 0;
    for (Candidate& candidate : block.planned()) {
      const std::uint32_t key = key_of(candidate.number);
      const std::span reached(block.reached.data() + first,
                              block.reached.data() + candidate.reached_end);
      candidate.has_won = std::all_of(reached.begin(), reached.end(), [&](std::uint32_t resource) {
        return holder_of_[resource] == key;
      });
      first = candidate.reached_end;
    }
  }

  void apply(Block& block, auto&& item_at) {
    for (Candidate& candidate : block.planned()) {
      BlockCommit commit{block, candidate};
      if (candidate.has_won) op_.apply(item_at(candidate.number), candidate.plan, commit);
      candidate.woken_end = static_cast<std::uint32_t>(block.woken.size());
    }
  }

  void end_block(Block& block, auto&& item_at, auto&& won, auto&& lost) {
    std::size_t first = 0;
    for (const Candidate& candidate : block.planned()) {
      const Item item = item_at(candidate.number);
      if (candidate.has_won) {
        ++report_.applied;
        made_.take_back(candidate.fresh);
        won(item, std::span<const Item>(block.woken).subspan(first, candidate.woken_end - first));
      } else {
        ++report_.lost;
        lost(item);
      }
      first = candidate.woken_end;
    }
  }

  const Executor& executor_;
  Op& op_;
  RoundsReport& report_;
  MadeThings<Op> made_;
  std::uint32_t highest_key_, first_key_ = highest_key_;
  std::vector<std::uint32_t> holder_of_;    // [resource], the key of the first item that has
                                            // reached it
  std::vector<std::uint64_t> by_priority_;  // of the window, priority and number
  std::vector<std::uint32_t> rank_of_;      // [number in the window], if there are priorities
  std::vector<Block> blocks_;               // of the window
};

}  // namespace ductile::runtime::detail
