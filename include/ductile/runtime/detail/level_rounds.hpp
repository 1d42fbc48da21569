/// @file
/// run_by_level: the strategy `reservations` for operators with levels. A round consists of all
/// present items of the lowest level, in order of arrival; items they wake come later.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/detail/ordered_run.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Waiting items by level, in a radix heap (Ahuja, Mehlhorn, Orlin & Tarjan, J. ACM 37, 1990):
/// levels never fall below the lowest taken, so items wait in 33 bags, by the highest bit in which
/// their level differs from that one. Items of one level keep their order of arrival. Thread
/// safety: one thread.
template <LevelledOperator Op>
class ItemsByLevel {
 public:
  using Item = typename Op::Item;

  explicit ItemsByLevel(const Op& op) : op_(op) {}

  /// Adds an item; one below the lowest level joins the lowest.
  void add(const Item& item) { bags_[std::bit_width(level_of(item) ^ lowest_)].push_back(item); }

  /// Moves all items of the lowest level to `items`. False if there is none.
  bool take_lowest(std::vector<Item>& items) {
    items.clear();
    if (bags_[0].empty()) deal_out();
    items.swap(bags_[0]);
    return !items.empty();
  }

  std::size_t size() const {
    std::size_t sum = 0;
    for (const std::vector<Item>& bag : bags_) sum += bag.size();
    return sum;
  }

 private:
  std::uint32_t level_of(const Item& item) const { return std::max(op_.level(item), lowest_); }

  /// Distributes the first non-empty bag among those before it.
  void deal_out() {
    const auto bag = std::find_if(bags_.begin() + 1, bags_.end(),
                                  [](const std::vector<Item>& items) { return !items.empty(); });
    if (bag == bags_.end()) return;
    std::uint32_t lowest = level_of(bag->front());
    for (const Item& item : *bag) lowest = std::min(lowest, level_of(item));
    lowest_ = lowest;
    for (const Item& item : *bag) add(item);
    bag->clear();
  }

  const Op& op_;
  std::array<std::vector<Item>, 33> bags_;
  std::uint32_t lowest_ = 0;
};

template <LevelledOperator Op>
RoundsReport run_by_level(const Executor& executor, Op& op,
                          const std::vector<typename Op::Item>& work, std::size_t most_rounds,
                          Sharing sharing = Sharing::where_faster) {
  using Item = typename Op::Item;
  RoundsReport report;
  ItemsByLevel<Op> waiting(op);
  for (const Item& item : work) waiting.add(item);
  const auto wake = [&](const Item& item) { waiting.add(item); };
  OrderedRun ordered(executor, op, report, wake, sharing);
  for (std::vector<Item> round; report.rounds < most_rounds && waiting.take_lowest(round);) {
    ++report.rounds;
    ordered.run(round, TellNobody());
  }
  report.left = waiting.size();
  return report;
}

}  // namespace ductile::runtime::detail
