/// @file
/// OperatorCheck: runs an Operator on one thread, item by item, and throws ContractBroken if it
/// does something that would be wrong, or would depend on timing, on many threads.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/contract.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/numbers.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

template <class Item>
std::string item_name(const Item& item, std::size_t place) {
  if constexpr (std::integral<Item>) {
    return std::to_string(item);
  } else if constexpr (requires {
                         { to_string(item) } -> std::convertible_to<std::string>;
                       }) {
    return to_string(item);
  } else {
    return "number " + std::to_string(place);
  }
}

template <Operator Op>
class OperatorCheck {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  /// In strategy in_order no item may be woken. In tiles and colours, items without conflicts run
  /// together, whatever they reach for.
  OperatorCheck(Op& op, Strategy strategy)
      : op_(op),
        in_order_(strategy == Strategy::in_order),
        by_conflicts_(strategy == Strategy::tiles || strategy == Strategy::colours) {
    if constexpr (kinds > 0) {
      const auto counts = op.counts();
      std::copy(counts.begin(), counts.end(), top_.begin());
      room_ = top_;
      if (top_[0] != op.resource_count())
        throw ContractBroken(ContractRule::numbers_in_range, "none", 1,
                             "counts()[0] is " + std::to_string(top_[0]) +
                                 ", but resource_count() is " +
                                 std::to_string(op.resource_count()));
    }
  }

  RoundsReport run(const std::vector<Item>& work) {
    RoundsReport report{.rounds = 1};
    for (const Item& item : work) add(item);
    if (in_order_) std::reverse(waiting_.begin(), waiting_.end());
    while (!waiting_.empty()) {
      const Numbered item = waiting_.back();
      waiting_.pop_back();
      if constexpr (ConflictingOperator<Op>) --waits_of_[item.item];
      if constexpr (has_levels) begin_item_of_level(item);
      ++report.planned;
      const bool is_applied = run_item(item);
      report.applied += is_applied;
      // In order, and for an applied item of a level, no wake is required
      if (!is_applied || !(in_order_ || has_levels)) considered_.push_back(item);
    }
    expect_nothing_left();
    renumber();
    return report;
  }

 private:
  static constexpr std::size_t kinds = kinds_made<Op>, watched = 32;
  static constexpr bool has_levels = LevelledOperator<Op>;
  static constexpr bool lowers_minima = requires { Op::lowers_minima; };

  /// An item with its position among all that were in the work or were woken.
  struct Numbered {
    Item item{};
    std::size_t number = 0;
    std::uint32_t level = 0;
  };

  /// The result of plan() for an item.
  struct Decision {
    Plan plan{};
    std::vector<std::uint32_t> reached;
    bool found = false;
  };

  /// Denies once, after a number of calls, and for invalid resources.
  struct ReachUpTo {
    std::vector<std::uint32_t>& reached;
    std::size_t calls, resource_count;
    bool operator()(std::uint32_t resource) {
      reached.push_back(resource);
      return reached.size() != calls + 1 && resource < resource_count;
    }
  };
  struct CheckedCommit {
    OperatorCheck& check;
    const Numbered& item;
    std::array<std::size_t, kinds> next{}, end{};
    std::vector<Item> postponed{};
    bool has_woken = false;
    void wake(const Item& also) {
      has_woken = true;
      check.add(also);
    }
    void postpone(const Item& also) {
      postponed.push_back(also);
      wake(also);
    }
    std::uint32_t fresh(std::size_t kind = 0) requires(kinds > 0) {
      if (next[kind] == end[kind])
        refuse(ContractRule::fresh_demanded, item,
               "apply() takes more fresh numbers of kind " + std::to_string(kind) +
                   " than demand() asked for");
      return static_cast<std::uint32_t>(next[kind]++);
    }
  };

  void add(const Item& item) {
    if constexpr (ConflictingOperator<Op>) {
      expect_known(item);
      ++waits_of_[item];
    }
    Numbered added{item, added_++};
    auto before = waiting_.end();
    if constexpr (has_levels) {
      added.level = std::max(level_, op_.level(item));
      before = std::partition_point(waiting_.begin(), waiting_.end(), [&](const Numbered& other) {
        return other.level > added.level;
      });
    }
    waiting_.insert(before, added);
  }
  void expect_known(std::uint32_t item) {
    waits_of_.resize(op_.resource_count());
    if (item >= waits_of_.size())
      throw ContractBroken(ContractRule::numbers_in_range, std::to_string(item), 1,
                           "it is in the work or was woken, but there are " +
                               std::to_string(waits_of_.size()) + " resources");
  }

  /// Items of one round of a level do not see those woken in it.
  void begin_item_of_level(const Numbered& item) {
    if (item.level != level_ || item.number >= round_end_) round_end_ = added_;
    level_ = item.level;
  }
  /// May an item share a window with the previous one?
  bool is_in_order_after(const Numbered& other) const {
    if constexpr (has_levels) return other.level == level_ && other.number < round_end_;
    return in_order_;
  }

  static std::string name_of(const Numbered& item) { return item_name(item.item, item.number); }
  [[noreturn]] static void refuse(ContractRule rule, const Numbered& item, const std::string& how) {
    throw ContractBroken(rule, name_of(item), 1, how);
  }

  static constexpr std::size_t all_calls = ~std::size_t{0};
  Decision decide(const Item& item, Plan plan = {}, std::size_t calls = all_calls) const {
    Decision decision{std::move(plan), {}, false};
    ReachUpTo reach{decision.reached, calls, resource_count()};
    decision.found = std::as_const(op_).plan(item, decision.plan, reach);
    return decision;
  }

  static bool is_same(const Decision& a, const Decision& b) {
    if (a.found != b.found || a.reached != b.reached) return false;
    if constexpr (std::equality_comparable<Plan>) return !a.found || a.plan == b.plan;
    return true;
  }

  bool run_item(const Numbered& item) {
    Decision decision = decide(item.item);
    // Leftovers of another item in a reused plan must not show.
    Decision again = decide(item.item, std::exchange(used_plan_, {}));
    if (!is_same(decision, again))
      refuse(ContractRule::plan_only_reads, item,
             "plan() called again, with a plan that was used before, decides something else");
    expect_in_range(item, decision);
    expect_gives_up(item, decision);
    if constexpr (ConflictingOperator<Op>) expect_conflicts_told(item, decision);
    if (decision.found) {
      if (decision.reached.empty())
        refuse(ContractRule::touches_announced, item,
               "it has a plan, but plan() has not reached for anything");
      apply(item, decision);
    }
    used_plan_ = std::move(again.plan);
    return decision.found;
  }

  void expect_in_range(const Numbered& item, const Decision& decision) const {
    const std::size_t count = resource_count();
    for (const std::uint32_t resource : decision.reached)
      if (resource >= count)
        refuse(ContractRule::numbers_in_range, item,
               "plan() reaches for " + std::to_string(resource) + ", but there are " +
                   std::to_string(count) + " resources");
  }
  std::size_t resource_count() const {
    if constexpr (kinds > 0) {
      return top_[0];
    } else {
      return op_.resource_count();
    }
  }

  void expect_gives_up(const Numbered& item, const Decision& decision) const {
    constexpr std::size_t most = 64;
    for (std::size_t calls = 0; calls < std::min(most, decision.reached.size()); ++calls) {
      const Decision denied = decide(item.item, {}, calls);
      if (denied.found || denied.reached.size() > calls + 1)
        refuse(ContractRule::gives_up_if_denied, item,
               "plan() goes on though reach(" + std::to_string(decision.reached[calls]) +
                   ") returned false");
      if (!std::equal(denied.reached.begin(), denied.reached.end(), decision.reached.begin()))
        refuse(ContractRule::plan_only_reads, item, "plan() called again reaches for other things");
    }
  }

  void expect_conflicts_told(const Numbered& item, const Decision& decision) const {
    const auto tells = [&](std::uint32_t who, std::uint32_t whom) {
      bool found = false;
      op_.conflicts(who, [&](std::uint32_t other) { found = found || other == whom; });
      return found;
    };
    for (const std::uint32_t other : decision.reached) {
      if (other == item.item) continue;
      if (!tells(item.item, other))
        refuse(ContractRule::touches_announced, item,
               "plan() reaches for " + std::to_string(other) + ", which conflicts() do not visit");
      if (!tells(other, item.item))
        refuse(ContractRule::conflicts_symmetric, item,
               "conflicts() visits item " + std::to_string(other) +
                   ", but that item's conflicts() do not visit it");
    }
  }

  void apply(const Numbered& item, Decision& decision) {
    const std::vector<Watched> others = watch_others();
    CheckedCommit commit{*this, item};
    if constexpr (kinds > 0) {
      take_numbers(op_.demand(decision.plan), commit);
      op_.apply(item.item, decision.plan, commit);
      for (std::size_t k = 0; k < kinds; ++k)
        holes_[k].add(
            {static_cast<std::uint32_t>(commit.next[k]), static_cast<std::uint32_t>(top_[k])});
    } else {
      op_.apply(item.item, decision.plan, commit);
    }
    if constexpr (DeferringOperator<Op>) op_.commit();
    std::sort(decision.reached.begin(), decision.reached.end());
    for (const Watched& other : others) expect_unchanged(other, item, decision.reached);
    if constexpr (ConflictingOperator<Op>)
      for (const Watched& other : others) expect_postponed(other, item, commit.postponed);
    if (in_order_ && commit.has_woken)
      refuse(ContractRule::nobody_woken, item,
             "it wakes an item, but in strategy in_order only the work itself has an order");
  }

  /// A waiting item that is observed.
  struct Watched {
    Numbered item;
    Decision before;
    std::vector<std::uint32_t> conflicts;  // ascending
  };

  std::vector<std::uint32_t> conflicts_of([[maybe_unused]] const Item& item) const {
    std::vector<std::uint32_t> conflicts;
    if constexpr (ConflictingOperator<Op>)
      op_.conflicts(item, [&](std::uint32_t other) { conflicts.push_back(other); });
    std::sort(conflicts.begin(), conflicts.end());
    return conflicts;
  }

  /// Some waiting items: the next ones and random ones.
  std::vector<Watched> watch_others() const {
    std::vector<Watched> others;
    for (std::size_t i = 0; i < std::min(watched, waiting_.size()); ++i) {
      const std::size_t random = mix64(added_ + considered_.size() * watched + i) % waiting_.size();
      const Numbered& other = waiting_[i < watched / 2 ? waiting_.size() - 1 - i : random];
      Decision decision = decide(other.item);
      if (!is_same(decide(other.item), decision))
        refuse(ContractRule::plan_only_reads, other, "plan() called again decides something else");
      others.push_back({other, std::move(decision), conflicts_of(other.item)});
    }
    return others;
  }

  /// Did they have no conflict before one was applied? An item may also wait twice.
  static bool may_run_beside([[maybe_unused]] const Watched& other,
                             [[maybe_unused]] const Numbered& applied) {
    if constexpr (ConflictingOperator<Op>)
      return other.item.item != applied.item &&
             !std::binary_search(other.conflicts.begin(), other.conflicts.end(), applied.item);
    return false;
  }

  /// If the applied item gave two waiting ones a new conflict, was one of them postponed?
  void expect_postponed(const Watched& other, const Numbered& applied,
                        const std::vector<Item>& postponed) const {
    const auto is_postponed = [&](std::uint32_t item) {
      return std::find(postponed.begin(), postponed.end(), item) != postponed.end();
    };
    if constexpr (requires { Op::keeps_conflicts; })
      if (conflicts_of(other.item.item) != other.conflicts)
        refuse(ContractRule::new_conflict_told, other.item,
               "its conflicts changed when item " + name_of(applied) +
                   " was applied, though the operator has a member keeps_conflicts");
    if (is_postponed(other.item.item)) return;
    for (const std::uint32_t with : conflicts_of(other.item.item))
      if (with != other.item.item && waits_of_[with] > 0 && !is_postponed(with) &&
          !std::binary_search(other.conflicts.begin(), other.conflicts.end(), with))
        refuse(ContractRule::new_conflict_told, other.item,
               "it got a conflict with item " + std::to_string(with) + " when item " +
                   name_of(applied) + " was applied, which has postponed neither");
  }

  /// `reached`, ascending, is what the applied item had reached.
  void expect_unchanged(const Watched& other, const Numbered& applied,
                        const std::vector<std::uint32_t>& reached) const {
    const auto had_reached = [&](std::uint32_t r) {
      return std::binary_search(reached.begin(), reached.end(), r);
    };
    const std::vector<std::uint32_t>& before = other.before.reached;
    const Decision after = decide(other.item.item);
    if (std::none_of(before.begin(), before.end(), had_reached)) {
      if (!is_same(after, other.before) && !(lowers_minima && !after.found))
        refuse(ContractRule::touches_announced, other.item,
               "its plan changed when item " + name_of(applied) +
                   " was applied, though the two have reached for nothing in common: one reads " +
                   "or writes what it has not reached for");
    } else if (by_conflicts_ && may_run_beside(other, applied)) {
      if (!is_same(after, other.before))
        refuse(ContractRule::touches_announced, other.item,
               "its plan changed when item " + name_of(applied) +
                   " was applied, with which it has no conflict: both may run at once, so neither "
                   "may read what the other writes to what both have reached");
    } else if (is_in_order_after(other.item)) {
      const bool is_known =
          std::all_of(after.reached.begin(), after.reached.end(), [&](std::uint32_t r) {
            return had_reached(r) || std::find(before.begin(), before.end(), r) != before.end();
          });
      if (!is_known || (after.found && !other.before.found))
        refuse(ContractRule::order_kept, other.item,
               "when item " + name_of(applied) + " was applied it got a plan, or reaches for " +
                   "what neither of them had reached: in order, the result would depend on the " +
                   "number of threads");
    }
  }

  /// Takes one more of each kind than demanded, so that there are gaps to close in the end.
  void take_numbers(const auto& wanted, CheckedCommit& commit) {
    bool has_room = true;
    for (std::size_t k = 0; k < kinds; ++k) {
      commit.next[k] = top_[k];
      commit.end[k] = top_[k] + wanted[k];
      top_[k] = commit.end[k] + 1;
      has_room = has_room && top_[k] <= room_[k];
      if (top_[k] > room_[k]) room_[k] = top_[k] + top_[k] / 2;
    }
    if (!has_room) op_.grow(room_);
  }

  void expect_nothing_left() const {
    if constexpr (requires { Op::forgoes_wakes; }) return;
    for (const Numbered& item : considered_)
      if (decide(item.item).found)
        refuse(ContractRule::woken_if_plannable, item,
               in_order_ ? "it had no plan at its turn and has one in the end"
                         : "it had its turn and has a plan again in the end, but nobody woke it");
  }

  void renumber() {
    for (std::size_t k = 0; k < kinds; ++k) {
      Numbers numbers(top_[k]);
      numbers.take_back({&holes_[k], 1});
      const std::vector<Renumbered> moved = numbers.close_holes();
      if constexpr (kinds > 0) op_.renumber(k, std::span<const Renumbered>(moved), numbers.top());
    }
  }

  Op& op_;
  bool in_order_, by_conflicts_;
  std::vector<Numbered> waiting_;        // the next last
  std::vector<std::uint32_t> waits_of_;  // [item], how many times it waits, if there are conflicts
  std::vector<Numbered> considered_;     // have had their turn
  std::size_t added_ = 0;
  std::uint32_t level_ = 0;    // the running level
  std::size_t round_end_ = 0;  // items with lower numbers existed when the round began
  Plan used_plan_{};
  std::array<std::size_t, kinds> top_{}, room_{};  // [kind]
  std::array<NumberPool, kinds> holes_;            // [kind]
};

}  // namespace ductile::runtime::detail
