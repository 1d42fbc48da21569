/// @file
/// CautiousCheck: runs a CautiousOperator on one thread, one item at a time, and throws
/// ContractBroken where it does something that would be wrong, or would depend on timing, on many.
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

#include "ductile/runtime/cautious_operator.hpp"
#include "ductile/runtime/contract.hpp"
#include "ductile/runtime/detail/made_things.hpp"
#include "ductile/runtime/detail/opposite_order.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime::detail {

template <CautiousOperator Op>
class CautiousCheck {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  /// Nobody may be woken if `in_order`.
  CautiousCheck(Op& op, bool in_order) : op_(op), in_order_(in_order) {
    if constexpr (kinds > 0) {
      const auto counts = op.counts();
      std::copy(counts.begin(), counts.end(), next_.begin());
      room_ = next_;
      if (next_[0] != op.resource_count())
        throw ContractBroken(ContractRule::numbers_in_range, "none", 1,
                             "counts()[0] is " + std::to_string(next_[0]) +
                                 ", but resource_count() is " +
                                 std::to_string(op.resource_count()));
    }
  }

  RoundsReport run(std::vector<Item> work) {
    RoundsReport report{.rounds = 1};
    if (in_order_) std::reverse(work.begin(), work.end());
    waiting_ = std::move(work);
    while (!waiting_.empty()) {
      const Item item = waiting_.back();
      waiting_.pop_back();
      ++report.planned;
      report.applied += run_item(item, report.planned - 1);
      considered_.push_back(item);
    }
    expect_nothing_left();
    if constexpr (kinds > 0)
      for (std::size_t k = 0; k < kinds; ++k) op_.renumber(k, {}, next_[k]);
    return report;
  }

 private:
  static constexpr std::size_t kinds = kinds_made<Op>, watched = 32;

  /// What plan() made of an item.
  struct Decision {
    Plan plan{};
    std::vector<std::uint32_t> reached;
    bool found = false;
  };

  /// Says no once, after a number of calls.
  struct ReachUpTo {
    std::vector<std::uint32_t>& reached;
    std::size_t calls;
    bool operator()(std::uint32_t resource) {
      reached.push_back(resource);
      return reached.size() != calls + 1;
    }
  };
  struct CheckedCommit {
    CautiousCheck& check;
    std::vector<Item> woken;
    std::array<std::size_t, kinds> taken{};
    void wake(const Item& item) { woken.push_back(item); }
    std::uint32_t fresh(std::size_t kind = 0) requires(kinds > 0) {
      ++taken[kind];
      return static_cast<std::uint32_t>(check.next_[kind]++);
    }
  };

  [[noreturn]] static void refuse(ContractRule rule, const Item& item, std::size_t place,
                                  const std::string& how) {
    throw ContractBroken(rule, item_name(item, place), 1, how);
  }

  static constexpr std::size_t all_calls = ~std::size_t{0};
  Decision decide(const Item& item, Plan plan = {}, std::size_t calls = all_calls) const {
    Decision decision{std::move(plan), {}, false};
    ReachUpTo reach{decision.reached, calls};
    decision.found = std::as_const(op_).plan(item, decision.plan, reach);
    return decision;
  }

  static bool is_same(const Decision& a, const Decision& b) {
    if (a.found != b.found || a.reached != b.reached) return false;
    if constexpr (std::equality_comparable<Plan>) return !a.found || a.plan == b.plan;
    return true;
  }

  bool run_item(const Item& item, std::size_t place) {
    Decision decision = decide(item);
    // A plan is filled in again and again: what another item left in it must not show.
    Decision again = decide(item, std::exchange(used_plan_, {}));
    if (!is_same(decision, again))
      refuse(ContractRule::plan_only_reads, item, place,
             "plan() called again, with a plan that was used before, decides something else");
    expect_in_range(item, place, decision);
    expect_gives_up(item, place, decision);
    if constexpr (ConflictingOperator<Op>) expect_conflicts_told(item, decision);
    if (decision.found) {
      if (decision.reached.empty())
        refuse(ContractRule::touches_announced, item, place,
               "it has a plan, but plan() has not reached for anything");
      apply(item, place, decision);
    }
    used_plan_ = std::move(again.plan);
    return decision.found;
  }

  void expect_in_range(const Item& item, std::size_t place, const Decision& decision) const {
    const std::size_t count = resource_count();
    for (const std::uint32_t resource : decision.reached)
      if (resource >= count)
        refuse(ContractRule::numbers_in_range, item, place,
               "plan() reaches for " + std::to_string(resource) + ", but there are " +
                   std::to_string(count) + " resources");
  }
  std::size_t resource_count() const {
    if constexpr (kinds > 0) {
      return next_[0];
    } else {
      return op_.resource_count();
    }
  }

  void expect_gives_up(const Item& item, std::size_t place, const Decision& decision) const {
    constexpr std::size_t most = 16;
    for (std::size_t calls = 0; calls < std::min(most, decision.reached.size()); ++calls) {
      const Decision denied = decide(item, {}, calls);
      if (denied.found || denied.reached.size() > calls + 1)
        refuse(ContractRule::gives_up_if_denied, item, place,
               "plan() goes on though reach(" + std::to_string(decision.reached[calls]) +
                   ") returned false");
      if (!std::equal(denied.reached.begin(), denied.reached.end(), decision.reached.begin()))
        refuse(ContractRule::plan_only_reads, item, place,
               "plan() called again reaches for other things");
    }
  }

  void expect_conflicts_told(std::uint32_t item, const Decision& decision) const {
    const auto tells = [&](std::uint32_t who, std::uint32_t whom) {
      bool found = false;
      op_.conflicts(who, [&](std::uint32_t other) { found = found || other == whom; });
      return found;
    };
    for (const std::uint32_t other : decision.reached) {
      if (other == item) continue;
      if (!tells(item, other))
        refuse(ContractRule::touches_announced, item, item,
               "plan() reaches for " + std::to_string(other) + ", which conflicts() do not visit");
      if (!tells(other, item))
        refuse(ContractRule::conflicts_symmetric, item, item,
               "conflicts() visits item " + std::to_string(other) +
                   ", but that item's conflicts() do not visit it");
    }
  }

  void apply(const Item& item, std::size_t place, Decision& decision) {
    std::vector<std::pair<Item, Decision>> others = watch_others(decision);
    CheckedCommit commit{*this, {}};
    if constexpr (kinds > 0) {
      const auto wanted = op_.demand(decision.plan);
      make_room(wanted);
      op_.apply(item, decision.plan, commit);
      for (std::size_t k = 0; k < kinds; ++k)
        if (commit.taken[k] > wanted[k])
          refuse(ContractRule::fresh_demanded, item, place,
                 "apply() took " + std::to_string(commit.taken[k]) + " fresh numbers of kind " +
                     std::to_string(k) + ", demand() asked for " + std::to_string(wanted[k]));
    } else {
      op_.apply(item, decision.plan, commit);
    }
    for (const auto& [other, before] : others)
      if (!is_same(decide(other), before))
        refuse(ContractRule::touches_announced, other, 0,
               "its plan changed when item " + item_name(item, place) +
                   " was applied, though the two have reached for nothing in common: one reads " +
                   "or writes what it has not reached for");
    if (in_order_ && !commit.woken.empty())
      refuse(ContractRule::nobody_woken, item, place,
             "it wakes an item, but in strategy in_order only the work itself has an order");
    waiting_.insert(waiting_.end(), commit.woken.begin(), commit.woken.end());
  }

  /// Some that wait, the next and random ones, which have nothing in common with what is applied.
  std::vector<std::pair<Item, Decision>> watch_others(const Decision& applied) const {
    std::vector<std::uint32_t> own = applied.reached;
    std::sort(own.begin(), own.end());
    std::vector<std::pair<Item, Decision>> others;
    for (std::size_t i = 0; i < std::min(watched, waiting_.size()); ++i) {
      const std::size_t random = mix64(considered_.size() * watched + i) % waiting_.size();
      const Item& other = waiting_[i < watched / 2 ? waiting_.size() - 1 - i : random];
      Decision decision = decide(other);
      const bool apart = std::none_of(
          decision.reached.begin(), decision.reached.end(),
          [&](std::uint32_t r) { return std::binary_search(own.begin(), own.end(), r); });
      if (apart) others.emplace_back(other, std::move(decision));
    }
    return others;
  }

  void make_room(const auto& wanted) {
    bool has_room = true;
    for (std::size_t k = 0; k < kinds; ++k) {
      const std::size_t needed = next_[k] + wanted[k];
      has_room = has_room && needed <= room_[k];
      if (needed > room_[k]) room_[k] = needed + needed / 2;
    }
    if (!has_room) op_.grow(room_);
  }

  void expect_nothing_left() const {
    if constexpr (requires { Op::forgoes_wakes; }) return;
    for (std::size_t i = 0; i < considered_.size(); ++i)
      if (decide(considered_[i]).found)
        refuse(ContractRule::woken_if_plannable, considered_[i], i,
               "it had its turn and has a plan again in the end, but nobody woke it");
  }

  Op& op_;
  bool in_order_;
  std::vector<Item> waiting_;     // the next last
  std::vector<Item> considered_;  // had their turn
  Plan used_plan_{};
  std::array<std::size_t, kinds> next_{}, room_{};  // [kind]
};

}  // namespace ductile::runtime::detail
