/// @file
/// OperatorCheck: the rules of an operator's contract, each a function that throws ContractBroken.
/// Rounds call them at the beginning and the end of a round and after each class, and leave
/// applying a batch to it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/detail/contract.hpp"
#include "ductile/runtime/detail/opposite_order.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

template <class Op>
class OperatorCheck {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;
  using Deferred = DeferredUpdate<typename Op::Update>;
  static constexpr bool on = true;

  void begin_round(const Op& op, std::uint32_t round, std::span<const Item> work) {
    round_ = round;
    reconsidered.clear();
    if constexpr (ColouredOperator<Op>) {
      note_waiting(op, work);
    } else {
      for (std::size_t i = 0; i < work.size(); ++i) expect_in_range(op, work[i], i);
    }
  }

  /// After a batch, for an item for which is_waiting(item) holds: it is still to have its turn and
  /// was not woken.
  void expect_kept(const Op& op, Item item, auto&& is_waiting) const requires ColouredOperator<Op> {
    const std::size_t i = place_of_[item];
    for (const std::uint32_t other : conflicts_of(op, item))
      if (is_waiting(other) &&
          !std::binary_search(conflicts_[i].begin(), conflicts_[i].end(), other))
        refuse(ContractRule::waiting_conflicts_kept, item, i,
               "it got a new conflict, with item " + std::to_string(other) +
                   ", while both waited for their turn, and nobody woke one of them");
    if constexpr (
        requires { Op::keeps_conflicts; } || requires { Op::forgoes_wakes; })
      return;
    if (std::find(reconsidered.begin(), reconsidered.end(), item) != reconsidered.end()) return;
    if (!same_plan<Op>(op.plan(item), plans_[i]))
      refuse(ContractRule::waiting_plan_kept, item, i,
             "its plan changed while it waited for its turn, and nobody woke it");
  }

  std::vector<Item> reconsidered;  ///< in this round, while they waited for their turn

  /// plans[i] and commits[i] belong to items[i].
  struct Batch {
    const std::vector<Item>& items;
    const std::vector<std::optional<Plan>>& plans;
    std::vector<Commit<Op>>& commits;
  };

  /// Applies and commits the plans of a batch one after the other.
  void run_batch(Op& op, const Batch& run, Deferred& deferred, CommitOrder order) {
    const auto& [batch, plans, commits] = run;
    const OppositeOrder<Op> opposite(op, plans, commits, order);
    for (std::size_t i = 0; i < batch.size(); ++i)
      expect_plan_only_reads(op, batch[i], i, plans[i]);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!plans[i]) continue;
      if (batch.size() > exact) expect_same_plan(op, batch[i], i, plans[i], "others");
      apply(op, batch[i], i, *plans[i], commits[i]);
      if constexpr (ImmediateOperator<Op>)
        if (batch.size() <= exact) expect_on_their_own(op, run, i);
      commit_all(op, deferred);
      if (batch.size() > exact) continue;
      for (std::size_t k = i + 1; k < batch.size(); ++k)
        if (plans[k]) expect_same_plan(op, batch[k], k, plans[k], "item " + item_name(batch[i], i));
    }
    if (!opposite.agrees(op))
      refuse(ContractRule::order_free, batch.front(), 0,
             "the batch of " + std::to_string(batch.size()) +
                 " that begins with it gives something else in the opposite order: items touch " +
                 "the same, or updates of one owner do not commute (see CommitOrder)");
    considered_.insert(considered_.end(), batch.begin(), batch.end());
  }

  /// An item of a reserving operator that visits nothing, and so leaves the work.
  void note_void(const Item& item) { considered_.push_back(item); }

  /// `woken`, ascending, come back in the next round.
  void end_round(const Op& op, const std::vector<Item>& woken) {
    if constexpr (requires { Op::forgoes_wakes; }) return;
    const auto same_item = [](const Item& a, const Item& b) { return !(a < b) && !(b < a); };
    std::sort(considered_.begin(), considered_.end());
    // Who was in the work twice may be here twice; set_difference would keep one of those woken.
    considered_.erase(std::unique(considered_.begin(), considered_.end(), same_item),
                      considered_.end());
    std::vector<Item> left;
    std::set_difference(considered_.begin(), considered_.end(), woken.begin(), woken.end(),
                        std::back_inserter(left));
    for (std::size_t i = 0; i < left.size(); ++i)
      if (!is_void<Op>(op, left[i]) && op.plan(left[i]))
        refuse(ContractRule::woken_if_plannable, left[i], i,
               "it had its turn and now has a plan again, but nobody woke it");
    considered_ = std::move(left);
  }

 private:
  static constexpr std::size_t exact = 256;  // in longer batches the other culprit is not named

  [[noreturn]] void refuse(ContractRule rule, const Item& item, std::size_t place,
                           const std::string& how) const {
    throw ContractBroken(rule, item_name(item, place), round_, how);
  }

  std::vector<std::uint32_t> conflicts_of(const Op& op, Item item) const {
    std::vector<std::uint32_t> all;
    op.conflicts(item, [&](std::uint32_t other) { all.push_back(other); });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Keeps what each item of the round plans and conflicts with at its beginning.
  void note_waiting(const Op& op, std::span<const Item> work) {
    place_of_.assign(op.item_count(), absent);
    conflicts_.clear();
    plans_.clear();
    for (std::size_t i = 0; i < work.size(); ++i) {
      expect_new(op, work[i], i);
      place_of_[work[i]] = static_cast<std::uint32_t>(i);
      conflicts_.push_back(conflicts_of(op, work[i]));
      plans_.push_back(op.plan(work[i]));
    }
    for (std::size_t i = 0; i < work.size(); ++i)
      for (const std::uint32_t other : conflicts_[i]) expect_symmetric(op, work[i], i, other);
  }

  /// Among those of the round that have their places already.
  void expect_new(const Op& op, Item item, std::size_t i) const {
    if (item >= op.item_count())
      refuse(ContractRule::numbers_in_range, item, i,
             "it is in the work, but item_count() is " + std::to_string(op.item_count()));
    if (place_of_[item] != absent)
      refuse(ContractRule::items_once, item, i,
             "it is in the work twice, at places " + std::to_string(place_of_[item]) + " and " +
                 std::to_string(i));
  }

  void expect_symmetric(const Op& op, Item item, std::size_t i, std::uint32_t other) const {
    if (other >= op.item_count())
      refuse(ContractRule::numbers_in_range, item, i,
             "conflicts() visits " + std::to_string(other) + ", but item_count() is " +
                 std::to_string(op.item_count()));
    if (place_of_[other] == absent || other == item) return;
    const auto& back = conflicts_[place_of_[other]];
    if (!std::binary_search(back.begin(), back.end(), item))
      refuse(ContractRule::conflicts_symmetric, item, i,
             "conflicts() visits item " + std::to_string(other) +
                 ", but that item's conflicts() do not visit it");
  }

  void expect_in_range(const Op& op, const Item& item, std::size_t i) const {
    op.footprint(item, [&](std::uint32_t resource) {
      if (resource >= op.resource_count())
        refuse(ContractRule::numbers_in_range, item, i,
               "footprint() visits " + std::to_string(resource) + ", but resource_count() is " +
                   std::to_string(op.resource_count()));
    });
  }

  void expect_plan_only_reads(const Op& op, const Item& item, std::size_t i,
                              const std::optional<Plan>& plan) const {
    if (!same_plan<Op>(op.plan(item), plan))
      refuse(ContractRule::plan_only_reads, item, i,
             "plan() called twice gives different plans, but it may only read");
  }

  void expect_same_plan(const Op& op, const Item& item, std::size_t i,
                        const std::optional<Plan>& plan, const std::string& others) const {
    if (is_void<Op>(op, item) || !same_plan<Op>(op.plan(item), plan))
      refuse(ContractRule::touches_announced, item, i,
             "its plan changed when " + others + " of its batch was applied: one " +
                 "touches what its " + (ColouredOperator<Op> ? "conflicts()" : "footprint()") +
                 " did not announce");
  }

  /// Those that may be planned while an item of the batch is applied, before its updates are
  /// committed. Whoever has no plan must not get one either, and nobody leaves the round.
  void expect_on_their_own(const Op& op, const Batch& run, std::size_t applied) const {
    const std::string other = "item " + item_name(run.items[applied], applied);
    const Commit<Op>& commit = run.commits[applied];
    for (std::size_t k = applied + 1; k < run.items.size(); ++k) {
      expect_same_plan(op, run.items[k], k, run.plans[k], other);
      if (commit.woken_at_[run.items[k]] == commit.window_)
        refuse(ContractRule::touches_announced, run.items[k], k,
               "it was woken by " + other + ", which its conflicts() did not announce");
    }
  }

  void apply(Op& op, const Item& item, std::size_t i, const Plan& plan, Commit<Op>& commit) const {
    try {
      apply_in_range(op, item, i, plan, commit);
    } catch (const UnknownItem& unknown) {
      refuse(ContractRule::numbers_in_range, item, i,
             std::string("while it was applied, ") + unknown.what());
    }
  }

  void apply_in_range(Op& op, [[maybe_unused]] const Item& item, [[maybe_unused]] std::size_t i,
                      const Plan& plan, Commit<Op>& commit) const {
    if constexpr (Kinds<Op>::count > 0) {
      const auto demand = op.demand(plan);
      const auto first = commit.next_;
      op.apply(plan, commit);
      for (std::size_t k = 0; k < demand.size(); ++k)
        if (commit.next_[k] - first[k] > demand[k])
          refuse(ContractRule::fresh_demanded, item, i,
                 "apply() took " + std::to_string(commit.next_[k] - first[k]) +
                     " fresh numbers of kind " + std::to_string(k) + ", demand() asked for " +
                     std::to_string(demand[k]));
    } else {
      op.apply(plan, commit);
    }
  }

  static constexpr std::uint32_t absent = 0xffffffffU;

  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> place_of_;                // [item], in the round's work, or absent
  std::vector<std::vector<std::uint32_t>> conflicts_;  // [place], ascending
  std::vector<std::optional<Plan>> plans_;             // [place]
  std::vector<Item> considered_;                       // had their turn and were not woken since
};

}  // namespace ductile::runtime::detail
