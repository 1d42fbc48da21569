/// @file
/// WokenItems: the items woken or postponed in a round, for strategies with conflicts, in which
/// each item has a turn known when the round begins.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

/// Thread safety: the caller between loops; where noted, any thread of a loop.
class WokenItems {
 public:
  using Item = std::uint32_t;

  static constexpr std::uint32_t absent = 0xffffffffU;  ///< turn of items that are not in the work

  /// The argument of apply().
  struct Commit {
    WokenItems& woken;
    std::uint32_t turn = 0;  ///< of the applied item

    void wake(Item item) const {
      const std::uint32_t own = woken.turn_of_[known(item, woken.turn_of_.size())];
      if (own == absent || own <= turn) woken.items_.mine().append(item);
    }
    void postpone(Item item) const {
      // Relaxed: a reader waits for this item, or does not conflict with the postponed one.
      std::uint32_t& round = woken.postponed_in_[known(item, woken.turn_of_.size())];
      std::atomic_ref(round).store(woken.round_, std::memory_order_relaxed);
      woken.bring_back(item);
    }
  };

  WokenItems(const Executor& executor, std::size_t resource_count)
      : items_(executor),
        postponed_in_(make_filled<std::uint32_t>(executor, resource_count)),
        turn_of_(make_filled<std::uint32_t>(executor, resource_count, absent)) {}

  void begin_round() { ++round_; }

  /// Adjusts to a larger number of resources.
  void grow(std::size_t resource_count) {
    postponed_in_.resize(resource_count, 0);
    turn_of_.resize(resource_count, absent);
  }

  /// [item], its turn: of two conflicting items the lower number runs first. The strategy sets it
  /// for a round's work and resets it to `absent` afterwards.
  UnsetVector<std::uint32_t>& turns() { return turn_of_; }

  /// Thread safety: any thread. May also be asked about an item that another thread plans
  /// concurrently; old and new value then mean the same.
  bool is_postponed(Item item) {
    return std::atomic_ref(postponed_in_[item]).load(std::memory_order_relaxed) == round_;
  }

  /// Thread safety: any thread.
  Commit commit() { return {*this}; }

  /// Adds an item to the next round. Thread safety: any thread.
  void bring_back(Item item) { items_.mine().append(item); }

  /// All items, each once, in order: the next round's work.
  UnsetVector<Item> take() {
    items_.collect_unique();
    return items_.take();
  }

 private:
  Worklist<Item> items_;
  UnsetVector<std::uint32_t> postponed_in_;  // [item], the last round
  UnsetVector<std::uint32_t> turn_of_;
  std::uint32_t round_ = 0;
};

[[noreturn]] inline void throw_twice(std::uint32_t item) {
  throw std::invalid_argument("item " + std::to_string(item) +
                              " is in the work twice, which operators with conflicts() do not " +
                              "allow");
}

/// Copies work, which has size() and operator[]. Throws std::out_of_range if an item is not the
/// number of a resource.
inline UnsetVector<std::uint32_t> known_items(const Executor& executor, const auto& work,
                                              std::size_t resource_count) {
  auto items = make_unset_vector<std::uint32_t>(executor, work.size());
  parallel_for(
      executor, items.size(), [&](std::size_t i) { items[i] = known(work[i], resource_count); },
      few_nanoseconds);
  return items;
}

}  // namespace ductile::runtime::detail
