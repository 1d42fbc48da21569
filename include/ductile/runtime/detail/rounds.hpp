/// @file
/// Rounds: the machinery behind run_rounds. A batch is a list of items that may run together; both
/// strategies only differ in how they cut a round's work into batches. Plans are kept by position
/// in the batch, and numbers of new things are handed out by a prefix sum over those positions,
/// so nothing depends on which thread did what.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic_count.hpp"
#include "ductile/runtime/atomic_min.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/colouring.hpp"
#include "ductile/runtime/detail/phase_timer.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime {

/// Instead of detail::OperatorCheck: nothing is checked.
struct NoCheck {
  static constexpr bool on = false;
};

template <class Op, class Check = NoCheck>
class Rounds {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  Rounds(const Executor& executor, Op& op, const RoundsOptions& options)
      : executor_(executor),
        op_(op),
        options_(options),
        recording_(executor.recording()),
        deferred_(executor, {.order = executor.deterministic() ? options.order : CommitOrder::any}),
        woken_(executor, {.order = WorkOrder::by_item, .unique = true}) {}

  RoundsReport run(std::vector<Item> work) {
    for (int round = 1; !work.empty() && round <= options_.most_rounds; ++round) {
      round_ = static_cast<std::uint32_t>(round);
      ++report_.rounds;
      if (recording_ != nullptr) recording_->begin_round();
      if constexpr (Check::on) check_.begin_round(op_, round_, work);
      if constexpr (ColouredOperator<Op>) {
        work = coloured_round(std::move(work));
      } else {
        work = reserved_round(std::move(work));
      }
    }
    if (recording_ != nullptr) recording_->end_rounds();
    report_.left = work.size();
    return report_;
  }

 private:
  static constexpr std::size_t kinds = detail::Kinds<Op>::count;
  static constexpr std::size_t block = 32;
  static constexpr LoopOptions by_block{.grain = 1, .serial_below = 3};

  // ---- Colouring: cut the round into classes of items that do not conflict ----

  /// Goes over the work window by window, so that what one window's classes touch stays in cache.
  std::vector<Item> coloured_round(std::vector<Item> work) requires ColouredOperator<Op> {
    woken_at_.resize(op_.item_count(), 0);
    const std::size_t window = Check::on ? work.size() : options_.window;
    for (std::size_t begin = 0; begin < work.size(); begin += window) {
      ++window_;
      run_window(std::span(work).subspan(begin, std::min(window, work.size() - begin)));
    }
    const std::vector<Item> woken = take_woken();
    // Who was woken by one window and planned in a later one has been considered again.
    return parallel_collect<Item>(executor_, woken.size(), [&](std::size_t i, auto&& append) {
      if (woken_at_[woken[i]] != 0) append(woken[i]);
    });
  }

  void run_window(std::span<const Item> work) {
    std::vector<std::vector<Item>> classes;
    {
      const PhaseTimer timer(report_.conflict_seconds, executor_, Phase::conflict);
      classes = independent_classes(work);
    }
    for (turn_ = 0; turn_ < classes.size(); ++turn_) {
      drop_woken(classes[turn_]);
      execute(classes[turn_]);
      if constexpr (Check::on) check_waiting(classes);
    }
    parallel_for(executor_, work.size(), [&](std::size_t i) { turn_of_[work[i]] = absent; });
  }

  std::vector<std::vector<Item>> independent_classes(std::span<const Item> work) {
    turn_of_.resize(op_.item_count(), absent);
    parallel_for(executor_, work.size(),
                 [&](std::size_t i) { turn_of_[work[i]] = static_cast<std::uint32_t>(i); });
    const CallbackGraph graph(work.size(), [&](std::uint32_t i, auto&& visit) {
      op_.conflicts(work[i], [&](Item other) {
        if (turn_of_[other] != absent) visit(turn_of_[other]);
      });
    });
    const Colouring colouring = colour(executor_, graph);
    const ColourClasses by_colour = colour_classes(executor_, colouring);
    std::vector<std::vector<Item>> classes(by_colour.count());
    for (std::uint32_t c = 0; c < by_colour.count(); ++c) {
      const auto members = by_colour.members(c);
      classes[c].resize(members.size());
      parallel_for(executor_, members.size(),
                   [&](std::size_t i) { classes[c][i] = work[members[i]]; });
    }
    // From here on the array holds each item's class instead of its position.
    parallel_for(executor_, work.size(),
                 [&](std::size_t i) { turn_of_[work[i]] = colouring.colour_of[i]; });
    return classes;
  }

  /// A colouring is stale where something changed: who was woken comes back in the next round.
  void drop_woken(std::vector<Item>& members) {
    if constexpr (requires { Op::keeps_conflicts; }) return;
    const PhaseTimer timer(report_.conflict_seconds, executor_, Phase::conflict);
    report_.dropped +=
        std::erase_if(members, [&](Item item) { return woken_at_[item] == window_; });
  }

  void check_waiting(const std::vector<std::vector<Item>>& classes) {
    for (std::size_t turn = turn_ + 1; turn < classes.size(); ++turn)
      for (const Item item : classes[turn])
        if (woken_at_[item] != window_) check_.expect_kept(op_, item);
  }

  // ---- Reservation: the highest priority on all of its footprint runs, the others wait ----

  std::vector<Item> reserved_round(std::vector<Item> work) requires ReservingOperator<Op> {
    std::vector<std::uint8_t> outcome(work.size());
    {
      const PhaseTimer timer(report_.conflict_seconds, executor_, Phase::conflict);
      reserved_.resize(op_.resource_count(), ~std::uint64_t{0});
      if (!executor_.deterministic()) ticket_of_.resize(work.size());
      parallel_for_blocks(
          executor_, work.size(), block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              outcome[i] = asks(i) ? reserve(work[i], i) : passes;
          },
          by_block);
      parallel_for_blocks(
          executor_, work.size(), block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              if (outcome[i] == waits && holds_all(work[i], i)) outcome[i] = runs;
          },
          by_block);
    }
    std::vector<Item> winners = select(work, outcome, runs);
    std::vector<Item> rest = select(work, outcome, waits | passes);
    const std::size_t lost = rest.size() - (share_ < everyone ? count(outcome, passes) : 0);
    report_.lost += lost;
    adapt_share(winners.size(), lost);
    execute(winners);
    const std::vector<Item> woken = take_woken();
    rest.insert(rest.end(), woken.begin(), woken.end());
    return rest;
  }

  /// Whether the item at this position asks for its footprint in this round.
  bool asks(std::size_t position) const {
    if (share_ == everyone) return true;
    return mix32(static_cast<std::uint32_t>(position) ^ (round_ * 0x85ebca6bU)) <= share_;
  }

  /// Fewer ask in the next round if too few of those that asked won, and more if most did.
  void adapt_share(std::size_t won, std::size_t lost) {
    const double asked = static_cast<double>(won + lost), wanted = options_.least_won * asked;
    if (won + lost < block || static_cast<double>(won) > (asked + wanted) / 2) {
      share_ = share_ > everyone / 2 ? everyone : 2 * share_ + 1;
    } else if (static_cast<double>(won) < wanted) {
      share_ /= 2;
    }
  }

  std::size_t count(const std::vector<std::uint8_t>& outcome, std::uint8_t wanted) const {
    const auto one_if_wanted = [&](std::size_t i) -> std::size_t { return outcome[i] == wanted; };
    const auto sum = [](std::size_t a, std::size_t b) { return a + b; };
    return parallel_reduce(executor_, outcome.size(), std::size_t{0}, one_if_wanted, sum);
  }

  /// A later round always has the lower key, so reservations never have to be cleared.
  std::uint64_t key_of(const Item& item, std::size_t position) {
    std::uint64_t rank = 0;
    if constexpr (RankedOperator<Op>) rank = op_.priority(item);
    const auto place = static_cast<std::uint32_t>(position);
    const std::uint32_t tie =
        executor_.deterministic() ? mix32(place ^ (round_ * 0x9e3779b9U)) : ticket_of_[position];
    return (std::uint64_t{~round_ & 0xffffffU} << 40U) | (rank << 32U) | tie;
  }

  std::uint8_t reserve(const Item& item, std::size_t position) {
    if (!executor_.deterministic()) ticket_of_[position] = atomic_count(ticket_);
    const std::uint64_t key = key_of(item, position);
    bool any = false;
    op_.footprint(item, [&](std::uint32_t resource) {
      atomic_min(reserved_[resource], key);
      any = true;
    });
    return any ? waits : gone;
  }

  bool holds_all(const Item& item, std::size_t position) {
    const std::uint64_t key = key_of(item, position);
    bool all = true;
    op_.footprint(item, [&](std::uint32_t resource) { all = all && reserved_[resource] == key; });
    return all;
  }

  /// The items with one of these outcomes, in order.
  std::vector<Item> select(const std::vector<Item>& work, const std::vector<std::uint8_t>& outcome,
                           std::uint8_t wanted) {
    std::vector<std::uint32_t> offset((work.size() + block - 1) / block);
    parallel_for_blocks(
        executor_, work.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) offset[b] += (outcome[i] & wanted) != 0;
        },
        by_block);
    std::vector<Item> selected(exclusive_scan<std::uint32_t>(executor_, offset));
    parallel_for_blocks(
        executor_, work.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          std::uint32_t at = offset[b];
          for (std::size_t i = begin; i < end; ++i)
            if ((outcome[i] & wanted) != 0) selected[at++] = work[i];
        },
        by_block);
    return selected;
  }

  // ---- One batch: plan, apply, commit ----

  void execute(const std::vector<Item>& batch) {
    if (batch.empty()) return;
    ++report_.batches;
    report_.planned += batch.size();
    plans_.clear();
    plans_.resize(batch.size());
    {
      const PhaseTimer timer(report_.plan_seconds, executor_, Phase::plan);
      parallel_for_blocks(
          executor_, batch.size(), block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
              if constexpr (ColouredOperator<Op>) woken_at_[batch[i]] = 0;
              plans_[i] = op_.plan(batch[i]);
              if (recording_ != nullptr) [[unlikely]]
                record_plan(batch[i]);
            }
          },
          by_block);
    }
    if constexpr (Check::on) return apply_checked(batch);
    {
      const PhaseTimer timer(report_.apply_seconds, executor_, Phase::apply);
      apply_plans();
    }
    const PhaseTimer timer(report_.commit_seconds, executor_, Phase::commit);
    report_.committed += deferred_.size();
    deferred_.commit(
        [&](std::uint32_t owner, const typename Op::Update& update) { op_.commit(owner, update); });
  }

  void apply_plans() {
    const std::size_t blocks = (plans_.size() + block - 1) / block;
    first_of_.assign(blocks, {});
    applied_of_.assign(blocks, 0);
    if constexpr (kinds > 0) number_new_things();
    parallel_for_blocks(
        executor_, plans_.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          Commit<Op> commit = new_commit();
          commit.next_ = first_of_[b];
          for (std::size_t i = begin; i < end; ++i) {
            if (plans_[i]) {
              commit.source_ = i;
              op_.apply(*plans_[i], commit);
              ++applied_of_[b];
            }
            if (recording_ != nullptr) [[unlikely]]
              record_apply(plans_[i]);
          }
        },
        by_block);
    for (const std::uint32_t applied : applied_of_) report_.applied += applied;
  }

  void apply_checked(const std::vector<Item>& batch) {
    first_of_.assign((batch.size() + block - 1) / block, {});
    if constexpr (kinds > 0) number_new_things();
    std::vector<Commit<Op>> commits(batch.size());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      commits[i] = new_commit();
      commits[i].source_ = i;
      commits[i].next_ = first_of_[i / block];
      if (!plans_[i]) continue;
      ++report_.applied;
      if constexpr (kinds > 0) {
        const auto demand = op_.demand(*plans_[i]);
        for (std::size_t k = 0; k < kinds; ++k) first_of_[i / block][k] += demand[k];
      }
    }
    check_.run_batch(op_, {batch, plans_, commits}, deferred_, options_.order);
  }

  /// Sets first_of_ to the first new number of each kind for each block of the batch.
  void number_new_things() {
    parallel_for_blocks(
        executor_, plans_.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            if (!plans_[i]) continue;
            const auto demand = op_.demand(*plans_[i]);
            for (std::size_t k = 0; k < kinds; ++k) first_of_[b][k] += demand[k];
          }
        },
        by_block);
    std::array<std::uint32_t, kinds> total{};
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) total[k] += std::exchange(first[k], total[k]);
    const std::array<std::uint32_t, kinds> base = op_.grow(total);
    for (auto& first : first_of_)
      for (std::size_t k = 0; k < kinds; ++k) first[k] += base[k];
  }

  Commit<Op> new_commit() {
    Commit<Op> commit;
    commit.deferred_ = &deferred_;
    commit.woken_ = &woken_;
    if constexpr (ColouredOperator<Op>) {
      commit.woken_at_ = &woken_at_;
      commit.turn_of_ = &turn_of_;
      commit.turn_ = static_cast<std::uint32_t>(turn_);
    }
    commit.window_ = window_;
    return commit;
  }

  void record_plan(const Item& item) {
    if constexpr (requires { op_.plan_cost(item); }) {
      recording_->end_item(op_.plan_cost(item));
    } else {
      recording_->end_item();
    }
  }

  void record_apply(const std::optional<Plan>& plan) {
    if constexpr (requires { op_.apply_cost(*plan); }) {
      recording_->end_item(plan ? op_.apply_cost(*plan) : 0.0);
    } else {
      recording_->end_item();
    }
  }

  std::vector<Item> take_woken() {
    const PhaseTimer timer(report_.wake_seconds, executor_, Phase::wake);
    woken_.collect();
    report_.woken += woken_.size();
    if constexpr (Check::on) {
      const auto items = woken_.items();
      check_.end_round(op_, {items.begin(), items.end()});
    }
    return woken_.take();
  }

  static constexpr std::uint32_t absent = 0xffffffffU;
  static constexpr std::uint8_t gone = 0, waits = 1, runs = 2, passes = 4;
  static constexpr std::uint32_t everyone = 0xffffffffU;

  const Executor& executor_;
  Op& op_;
  RoundsOptions options_;
  [[no_unique_address]] Check check_;
  RoundsReport report_;
  Recording* recording_;  // null but for replays
  DeferredUpdate<typename Op::Update> deferred_;
  Worklist<Item> woken_;
  std::uint32_t round_ = 0;
  std::uint32_t window_ = 0;             // the window being run, colouring only
  std::vector<std::uint32_t> woken_at_;  // [item], the window, or 0 if planned since
  std::vector<std::uint32_t> turn_of_;   // [item], its place in the work, then its class, or absent
  std::size_t turn_ = 0;                 // class being executed, colouring only
  std::vector<std::uint64_t> reserved_;  // [resource], the lowest key that asked
  std::vector<std::uint32_t> ticket_of_;  // [position], racing mode: order of arrival
  std::uint32_t ticket_ = 0;
  std::uint32_t share_ = everyone;          // who has a hash up to this asks, reservation only
  std::vector<std::optional<Plan>> plans_;  // [position in the batch]
  std::vector<std::array<std::uint32_t, kinds>> first_of_;  // [block of the batch][kind]
  std::vector<std::uint32_t> applied_of_;                   // [block of the batch]
};

}  // namespace ductile::runtime
