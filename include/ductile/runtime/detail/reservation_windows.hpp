/// @file
/// ReservationWindows: the strategy `reservations`. A window of the work is planned at once; an
/// item with a plan reserves what it has reached, the lowest place in the window wins, and items
/// that hold all they have reached are applied. The share of losers determines the size of the next
/// window. If items have priorities, places follow their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime::detail {

template <Operator Op>
class ReservationWindows {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  /// Keys fall from this one and restart there when used up. It is at least the size of the largest
  /// window.
  ReservationWindows(const Executor& executor, Op& op, std::uint32_t highest_key = nobody)
      : executor_(executor), op_(op), made_(op), highest_key_(highest_key) {}
  static constexpr std::uint32_t nobody = 0xffffffffU;  ///< holds a resource that no item has
                                                        ///< reached
  static constexpr std::size_t most_window = 8192;      ///< items in a window

  /// The losers and the woken items are the next pass's work.
  RoundsReport run(std::vector<Item> work, std::size_t most_passes) {
    while (!work.empty() && report_.rounds < most_passes) {
      ++report_.rounds;
      if constexpr (RankedOperator<Op>) {
        run_pass(work, [](std::size_t i) { return i; });
      } else {
        run_pass(work, Strides(work.size(), window_));
      }
      work.swap(lost_);
      lost_.clear();
      work.insert(work.end(), woken_.begin(), woken_.end());
      woken_.clear();
    }
    return finish(work.size());
  }

 private:
  void run_pass(const std::vector<Item>& work, auto&& place_at) {
    for (std::size_t at = 0; at < work.size();) {
      const std::size_t count = std::min(window_, work.size() - at);
      run_window(count, [&](std::size_t i) -> const Item& { return work[place_at(at + i)]; });
      at += count;
    }
  }

  /// The order 0, k, 2 k, ..., 1, 1 + k, ... of n places, for k of about n / window: items that are
  /// far apart in the work seldom touch.
  class Strides {
   public:
    Strides(std::size_t n, std::size_t window)
        : step_((n + window - 1) / window), each_(n / step_), longer_(n % step_) {}
    std::size_t operator()(std::size_t i) const {
      const std::size_t in_longer = longer_ * (each_ + 1);
      if (i < in_longer) return i % (each_ + 1) * step_ + i / (each_ + 1);
      return (i - in_longer) % each_ * step_ + longer_ + (i - in_longer) / each_;
    }

   private:
    std::size_t step_, each_, longer_;
  };

  enum class Outcome : std::uint8_t { nothing, lost, won };
  struct Slot {
    Item item{};
    Plan plan{};
    std::vector<std::uint32_t> reached;
    std::vector<Item> woken;
    typename MadeThings<Op>::New fresh;
    Outcome outcome = Outcome::nothing;
  };

  struct SlotCommit {
    Slot& slot;
    void wake(const Item& item) { slot.woken.push_back(item); }
    void postpone(const Item& item) { wake(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(MadeThings<Op>::kinds > 0) {
      return slot.fresh.take(kind);
    }
  };

  void run_window(std::size_t count, auto&& item_at) {
    ++report_.batches;
    begin_window(count, item_at);
    {
      const PhaseTimer timer(report_.plan_seconds);
      parallel_for(
          executor_, count,
          [&](std::size_t i) {
            prefetch_after(i, count, item_at);
            plan(slots_[i], item_at(i), i);
          },
          grain);
    }
    const PhaseTimer timer(report_.apply_seconds);
    if constexpr (MadeThings<Op>::kinds > 0) {
      parallel_for(
          executor_, count, [&](std::size_t i) { settle(slots_[i], i); }, grain);
      made_.number(std::span(slots_).first(count),
                   [](const Slot& slot) { return slot.outcome == Outcome::won; });
      parallel_for(
          executor_, count, [&](std::size_t i) { apply(slots_[i]); }, grain);
    } else {
      parallel_for(
          executor_, count,
          [&](std::size_t i) {
            settle(slots_[i], i);
            apply(slots_[i]);
          },
          grain);
    }
    end_window(count);
  }

  /// Keys fall from window to window, so that reservations of earlier windows do not count.
  void begin_window(std::size_t count, auto&& item_at) {
    if constexpr (RankedOperator<Op>) rank(count, item_at);
    if (slots_.size() < count) slots_.resize(count);
    if (first_key_ < count) {
      std::fill(holder_of_.begin(), holder_of_.end(), nobody);
      first_key_ = highest_key_;
    }
    first_key_ -= static_cast<std::uint32_t>(count);
    holder_of_.resize(std::max(holder_of_.size(), op_.resource_count()), nobody);
  }

  /// Ranks the window's places by priority; of equal ones, the first in the work comes first.
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
    if constexpr (RankedOperator<Op>) {
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

  void plan(Slot& slot, const Item& item, std::size_t i) {
    slot.item = item;
    slot.reached.clear();
    slot.woken.clear();
    ReachToNote reach{slot.reached};
    slot.outcome = op_.plan(slot.item, slot.plan, reach) ? Outcome::lost : Outcome::nothing;
    if (slot.outcome == Outcome::lost)
      for (const std::uint32_t resource : slot.reached) reserve(holder_of_[resource], key_of(i));
  }
  void reserve(std::uint32_t& holder, std::uint32_t key) const {
    if (executor_.threads() > 1) {
      atomic_min(holder, key);
    } else {
      holder = std::min(holder, key);
    }
  }

  void settle(Slot& slot, std::size_t i) {
    if (slot.outcome == Outcome::nothing) return;
    const std::uint32_t key = key_of(i);
    if (std::all_of(slot.reached.begin(), slot.reached.end(),
                    [&](std::uint32_t resource) { return holder_of_[resource] == key; }))
      slot.outcome = Outcome::won;
  }

  void apply(Slot& slot) {
    SlotCommit commit{slot};
    if (slot.outcome == Outcome::won) op_.apply(slot.item, slot.plan, commit);
  }

  void end_window(std::size_t count) {
    std::size_t won = 0, lost = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[i];
      if (slot.outcome == Outcome::lost) {
        ++lost;
        lost_.push_back(slot.item);
      } else if (slot.outcome == Outcome::won) {
        ++won;
        woken_.insert(woken_.end(), slot.woken.begin(), slot.woken.end());
        made_.take_back(slot.fresh);
      }
    }
    report_.planned += count;
    report_.applied += won;
    report_.lost += lost;
    if (4 * lost > won) window_ = std::max(least_window, window_ / 2);
    if (16 * lost < won) window_ = std::min(most_window, window_ * 2);
  }

  RoundsReport finish(std::size_t left) {
    report_.left = left;
    made_.close_holes();
    return report_;
  }

  static constexpr std::size_t least_window = 64, first_window = 2048;
  static constexpr LoopOptions grain{.grain = 32};

  const Executor& executor_;
  Op& op_;
  MadeThings<Op> made_;
  std::vector<Slot> slots_;               // [place in the window]
  std::vector<std::uint32_t> holder_of_;  // [resource], the key of the first item that has reached
                                          // it
  std::uint32_t highest_key_, first_key_ = highest_key_;
  std::vector<std::uint64_t> by_priority_;  // of the window, priority and place
  std::vector<std::uint32_t> rank_of_;      // [place in the window], if there are priorities
  std::size_t window_ = first_window;
  std::vector<Item> lost_, woken_;
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
