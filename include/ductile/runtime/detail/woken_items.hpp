/// @file
/// WokenItems: which items were woken in a round, for the strategies in which those leave it.
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

/// Thread safety: the caller between loops; where it is said, any thread of a loop.
class WokenItems {
 public:
  using Item = std::uint32_t;

  /// What apply() is handed.
  struct Commit {
    WokenItems* woken;
    void wake(Item item) {
      // Relaxed: whoever reads it waits for this one, or does not conflict with the item.
      std::uint32_t& round = woken->woken_in_[known(item, woken->woken_in_.size())];
      std::atomic_ref(round).store(woken->round_, std::memory_order_relaxed);
      woken->items_.mine().append(item);
    }
  };

  WokenItems(const Executor& executor, std::size_t resource_count)
      : items_(executor), woken_in_(make_filled<std::uint32_t>(executor, resource_count)) {}

  void begin_round() { ++round_; }

  /// Thread safety: any thread. Also asked ahead of an item that another thread plans meanwhile:
  /// what it reads is either of two that say the same.
  bool has(Item item) {
    return std::atomic_ref(woken_in_[item]).load(std::memory_order_relaxed) == round_;
  }

  /// Thread safety: any thread.
  Commit commit() { return {this}; }

  /// An item that comes back in the next round though nobody has woken it. Thread safety: any
  /// thread.
  void postpone(Item item) { items_.mine().append(item); }

  /// All of them, each once, in order: the next round's work.
  UnsetVector<Item> take() {
    items_.collect_unique();
    return items_.take();
  }

 private:
  Worklist<Item> items_;
  UnsetVector<std::uint32_t> woken_in_;  // [item], the last round
  std::uint32_t round_ = 0;
};

[[noreturn]] inline void throw_twice(std::uint32_t item) {
  throw std::invalid_argument("item " + std::to_string(item) +
                              " is in the work twice, which operators with conflicts() do not " +
                              "allow");
}

/// Copies work, which has size() and items by [i]. Throws std::out_of_range if an item is not the
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
