/// @file
/// Batches: sets of items that may run together, planned, applied and committed. Both strategies of
/// rounds only differ in how they cut a round's work into batches. Plans are kept by position in
/// the batch, and numbers of new things are handed out by a prefix sum over those positions, so
/// nothing depends on which thread did what.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/detail/slots.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/rounds_report.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

/// Of what takes well under a microsecond an item, so many are handed out at once.
constexpr std::size_t short_block = 32;
constexpr LoopOptions by_block{.grain = 1, .serial_below = 3};

constexpr auto all_are_here = [](const auto&) { return true; };

/// Has items soon after position i for which is_here(item) brought into the cache, if the operator
/// can. What memory takes to answer is about as long as planning two items.
template <class Op>
[[gnu::always_inline]] inline void prefetch_items_after(const Op& op,
                                                        std::span<const typename Op::Item> batch,
                                                        std::size_t i, auto&& is_here) {
  if constexpr (PrefetchingOperator<Op>)
    for (const int stage : {2, 1, 0}) {
      const std::size_t ahead = i + 2 * (static_cast<std::size_t>(stage) + 1);
      if (ahead < batch.size() && is_here(batch[ahead])) op.prefetch(batch[ahead], stage);
    }
}

/// The same for the first items of a batch from `begin` on, ahead of which nobody was.
template <class Op>
void prefetch_first_items(const Op& op, std::span<const typename Op::Item> batch, std::size_t begin,
                          auto&& is_here) {
  if constexpr (PrefetchingOperator<Op>)
    for (const int stage : {2, 1, 0}) {
      const std::size_t end = begin + 2 * (static_cast<std::size_t>(stage) + 1);
      for (std::size_t i = begin; i < std::min(batch.size(), end); ++i)
        if (is_here(batch[i])) op.prefetch(batch[i], stage);
    }
}

/// What the batches of a run share. Check is OperatorCheck, or says by `on` that there is none.
template <class Op, class Check>
class Batches {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;
  using Update = typename Op::Update;

  Batches(const Executor& run_on, Op& applied, const RoundsOptions& wanted)
      : executor(run_on),
        op(applied),
        options(wanted),
        deferred_(run_on, {.order = run_on.deterministic() ? wanted.order : CommitOrder::any}),
        woken_(run_on, {.order = WorkOrder::by_item, .unique = true}) {}

  const Executor& executor;
  Op& op;
  const RoundsOptions options;
  [[no_unique_address]] Check check;
  RoundsReport report;

  /// Runs a batch: tells planning(item) of those items for which is_here(item), and plans them;
  /// new_commit() is what a plan is applied with; grown() is called when the operator has grown.
  void run(std::span<const Item> batch, auto&& is_here, auto&& planning, auto&& new_commit,
           auto&& grown) {
    if (batch.empty()) return;
    ++report.batches;
    if constexpr (ImmediateOperator<Op> && !Check::on) {
      plan_and_apply(batch, is_here, planning, new_commit);
    } else {
      plan_all(batch, is_here, planning);
      if constexpr (Check::on) return apply_checked(batch, is_here, new_commit, grown);
      const PhaseTimer timer(report.apply_seconds);
      apply_plans(new_commit, grown);
    }
    const PhaseTimer timer(report.commit_seconds);
    report.committed += deferred_.commit(
        [&](std::uint32_t owner, Update& update) { op.commit(owner, std::move(update)); });
  }

  /// What plans are applied with, save what the strategy adds.
  Commit<Op> new_commit(std::uint32_t window) {
    Commit<Op> commit;
    commit.deferrer_ = deferred_.deferrer();
    commit.woken_ = &woken_;
    commit.window_ = window;
    if constexpr (Check::on) commit.reconsidered_ = &check.reconsidered;
    return commit;
  }

  /// The items woken since the last call, each once, in order.
  UnsetVector<Item> take_woken() {
    const PhaseTimer timer(report.wake_seconds);
    woken_.collect();
    report.woken += woken_.size();
    if constexpr (Check::on) {
      const auto items = woken_.items();
      check.end_round(op, {items.begin(), items.end()});
    }
    return woken_.take();
  }

 private:
  static constexpr std::size_t kinds = Kinds<Op>::count;

  /// Few of a small batch are handed out at once, so that each of many threads gets some.
  static std::size_t block_of(std::size_t items) {
    return std::clamp<std::size_t>(items / 1024, 2, short_block);
  }

  void cut_into_blocks(std::size_t items, std::size_t block_size) {
    size_ = items;
    block_size_ = block_size;
    planned_of_.assign((items + block_size_ - 1) / block_size_, 0);
    applied_of_.assign(planned_of_.size(), 0);
  }

  /// Asks ahead only for items of the same block that are in the round: others change meanwhile
  /// what belongs to theirs, and to those that have left it.
  void plan_and_apply(std::span<const Item> batch, auto&& is_here, auto&& planning,
                      auto&& new_commit) {
    const auto threads = static_cast<std::size_t>(executor.threads());
    const std::size_t shared = std::clamp<std::size_t>(batch.size() / (16 * threads), 2, 256);
    cut_into_blocks(batch.size(), threads == 1 ? batch.size() : shared);
    const PhaseTimer timer(report.plan_seconds);
    for_each_block([&](std::size_t b, std::size_t begin, std::size_t end) {
      const std::span<const Item> block_and_before = batch.first(end);
      prefetch_first_items(op, block_and_before, begin, is_here);
      Commit<Op> commit = new_commit();
      for (std::size_t i = begin; i < end; ++i) {
        prefetch_items_after(op, block_and_before, i, is_here);
        if (is_here(batch[i])) {
          ++planned_of_[b];
          planning(batch[i]);
          if (const std::optional<Plan> plan = op.plan(batch[i])) {
            ++applied_of_[b];
            commit.source_ = i;
            op.apply(*plan, commit);
          }
        }
      }
    });
    count_planned();
    count_applied();
  }

  void count_planned() {
    const std::size_t planned = std::accumulate(planned_of_.begin(), planned_of_.end(), 0U);
    report.planned += planned;
    report.dropped += size_ - planned;
  }
  void count_applied() {
    report.applied += std::accumulate(applied_of_.begin(), applied_of_.end(), 0U);
  }

  void plan_all(std::span<const Item> batch, auto&& is_here, auto&& planning) {
    cut_into_blocks(batch.size(), block_of(batch.size()));
    plans_.provide(executor, size_);
    first_of_.assign(planned_of_.size(), {});
    const PhaseTimer timer(report.plan_seconds);
    for_each_block([&](std::size_t b, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        prefetch_items_after(op, batch, i, is_here);
        const bool here = is_here(batch[i]);
        planned_of_[b] += here;
        if (here) planning(batch[i]);
        plan(batch[i], here, plans_[i]);
        if constexpr (kinds > 0) add_demand(plans_[i], first_of_[b]);
      }
    });
    count_planned();
  }

  void for_each_block(auto&& body) {
    parallel_for_blocks(executor, size_, block_size_, body, by_block);
  }

  /// Plans an item, unless it left the round.
  void plan(const Item& item, bool here, std::optional<Plan>& plan) {
    if (here) {
      plan = op.plan(item);
    } else {
      plan.reset();
    }
  }

  void apply_plans(auto&& new_commit, auto&& grown) {
    if constexpr (kinds > 0) number_new_things(), grown();
    for_each_block([&](std::size_t b, std::size_t begin, std::size_t end) {
      Commit<Op> commit = new_commit();
      commit.next_ = first_of_[b];
      for (std::size_t i = begin; i < end; ++i) {
        if (plans_[i]) {
          commit.source_ = i;
          op.apply(*plans_[i], commit);
          ++applied_of_[b];
        }
      }
    });
    count_applied();
  }

  void apply_checked(std::span<const Item> all, auto&& is_here, auto&& new_commit, auto&& grown) {
    std::vector<Item> batch;
    std::vector<std::optional<Plan>> plans;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (is_here(all[i])) batch.push_back(all[i]), plans.push_back(std::move(plans_[i]));
    std::vector<std::array<std::uint32_t, kinds>> first_of(batch.size());
    if constexpr (kinds > 0) number_one_by_one(plans, first_of), grown();
    std::vector<Commit<Op>> commits(batch.size(), new_commit());
    for (std::size_t i = 0; i < batch.size(); ++i)
      commits[i].source_ = i, commits[i].next_ = first_of[i];
    report.applied += batch.size() - std::count(plans.begin(), plans.end(), std::nullopt);
    check.run_batch(op, {batch, plans, commits}, deferred_, options.order);
  }

  void add_demand(const std::optional<Plan>& plan, std::array<std::uint32_t, kinds>& sum) const {
    if (!plan) return;
    const auto demand = op.demand(*plan);
    for (std::size_t k = 0; k < kinds; ++k) sum[k] += demand[k];
  }

  /// Turns what each block of the batch asks for of each kind into its first new number.
  void number_new_things() {
    std::array<std::uint32_t, kinds> total{};
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) total[k] += std::exchange(first[k], total[k]);
    const std::array<std::uint32_t, kinds> base = op.grow(total);
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) first[k] += base[k];
  }

  /// The same for single items.
  void number_one_by_one(const std::vector<std::optional<Plan>>& plans,
                         std::vector<std::array<std::uint32_t, kinds>>& first_of) {
    std::array<std::uint32_t, kinds> total{};
    for (std::size_t i = 0; i < plans.size(); ++i) {
      first_of[i] = total;
      add_demand(plans[i], total);
    }
    const std::array<std::uint32_t, kinds> base = op.grow(total);
    for (auto& first : first_of)
      for (std::size_t k = 0; k < kinds; ++k) first[k] += base[k];
  }

  DeferredUpdate<Update> deferred_;
  Worklist<Item> woken_;

  // ---- The batch ----
  std::size_t size_ = 0, block_size_ = 1;  // its items, and those of a block
  Slots<Plan> plans_;                      // [position]; there may be old ones beyond its size
  std::vector<std::uint32_t> planned_of_;  // [block]
  std::vector<std::array<std::uint32_t, kinds>> first_of_;  // [block][kind], demanded, then first
  std::vector<std::uint32_t> applied_of_;                   // [block]
};

/// Cuts work into `windows` parts that run one after the other.
template <class Item>
void for_each_window(std::span<Item> work, std::size_t windows, auto&& run) {
  const std::size_t n = work.size();
  for (std::size_t w = 0; w < windows; ++w) {
    const std::size_t begin = n * w / windows, end = n * (w + 1) / windows;
    run(work.subspan(begin, end - begin));
  }
}

/// How many windows of at most `largest` items there are to be; 0: work is one part.
inline std::size_t window_count(std::size_t items, std::size_t largest) {
  return largest == 0 ? 1 : items / largest + (items % largest != 0);
}

}  // namespace ductile::runtime::detail
