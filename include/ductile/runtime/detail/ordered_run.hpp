/// @file
/// OrderedRun: runs items in the order of the work, for the strategy `in_order` and within a level.
/// Parts of the work are run by a plain loop or as a window of reservations, whose losers one
/// thread runs in order afterwards; whichever has been faster so far is used. The result is the
/// same.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/detail/reservation_windows.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Which parts several threads run. Tests use `always`.
enum class Sharing : std::uint8_t { where_faster, always };

/// Chooses between a plain loop and several threads for each part of a run. Tries both from time to
/// time, ever less often while the same one wins.
class FasterWay {
 public:
  /// Runs a part of so many items by plain() or at_once().
  void run(std::size_t count, auto&& plain, auto&& at_once) {
    const auto items = static_cast<double>(count);
    if (plain_ < too_fast_to_share || items * plain_ < too_short_to_share) {
      plain_ = timed(plain) / items;
      return;
    }
    if (trial_ == 0 && --until_trial_ == 0) begin_trial();
    const bool is_at_once = trial_ > 0 ? trial_ % 2 == 0 : at_once_wins_;
    double& best = is_at_once ? best_at_once_ : best_plain_;
    const double time = (is_at_once ? timed(at_once) : timed(plain)) / items;
    best = std::min(best, time);
    if (!is_at_once) plain_ = time;
    if (trial_ > 0 && --trial_ == 0) end_trial();
  }

 private:
  static constexpr std::size_t tried_often = 64, tried_seldom = 1024;  // parts between two trials
  static constexpr double too_short_to_share = 8000;                   // nanoseconds, a part
  static constexpr double too_fast_to_share = 8;  // nanoseconds two cores need to share an item

  /// Calls run(); returns nanoseconds.
  static double timed(auto&& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start)
        .count();
  }

  void begin_trial() {
    trial_ = 4;  // the best of two parts each, because other programs may use the cores meanwhile
    best_plain_ = best_at_once_ = std::numeric_limits<double>::max();
  }
  void end_trial() {
    const bool wins = best_at_once_ < best_plain_;
    tried_every_ = wins == at_once_wins_ ? std::min(2 * tried_every_, tried_seldom) : tried_often;
    until_trial_ = tried_every_;
    at_once_wins_ = wins;
  }

  double plain_ = 0;                          // nanoseconds per item, the last time it was used
  double best_plain_ = 0, best_at_once_ = 0;  // in a trial
  bool at_once_wins_ = false;
  std::size_t trial_ = 0;  // parts left in the current trial
  std::size_t until_trial_ = 1, tried_every_ = tried_often;
};

/// One run. wake(item) is called for the items that others wake, in the order of the work.
template <Operator Op, class Wake>
class OrderedRun {
 public:
  using Item = typename Op::Item;

  OrderedRun(const Executor& executor, Op& op, RoundsReport& report, Wake wake,
             Sharing sharing = Sharing::where_faster)
      : executor_(executor),
        op_(op),
        report_(report),
        commit_{std::move(wake)},
        sharing_(sharing) {}

  /// Runs work, which has size() and operator[]. Calls applied(item) for each applied item, in
  /// order.
  void run(const auto& work, auto&& applied) {
    const bool is_alone = executor_.threads() == 1 && sharing_ == Sharing::where_faster;
    const std::size_t part = is_alone ? work.size() : Windows::most_items;
    for (std::size_t begin = 0; begin < work.size(); begin += part) {
      const std::size_t end = std::min<std::size_t>(begin + part, work.size());
      const auto plain = [&] {
        report_.planned += end - begin;
        run_plainly(work, begin, end, applied);
      };
      const auto at_once = [&] { run_at_once(work, begin, end, applied); };
      if (sharing_ == Sharing::always) {
        at_once();
      } else if (is_alone) {
        plain();
      } else {
        faster_.run(end - begin, plain, at_once);
      }
    }
  }

 private:
  using Plan = typename Op::Plan;
  using Windows = ReservationWindows<Op>;

  struct Commit {
    Wake wake;
    void postpone(const Item& item) { wake(item); }
  };

  /// What each item changes is local, so that compilers can keep it in registers.
  void run_plainly(const auto& work, std::size_t begin, std::size_t end, auto&& applied) {
    ReachAll reach;
    Plan plan = std::move(plan_);
    std::size_t done = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Item item = work[i];
      if (!op_.plan(item, plan, reach)) continue;
      op_.apply(item, plan, commit_);
      applied(item);
      ++done;
    }
    report_.applied += done;
    plan_ = std::move(plan);
  }

  /// An item without a plan is done, because earlier items of its window cannot give it one.
  void run_at_once(const auto& work, std::size_t begin, std::size_t end, auto&& applied) {
    if (!windows_) windows_.emplace(executor_, op_, report_);
    const auto won = [&](const Item& item, std::span<const Item> woken) {
      for (const Item& other : woken) commit_.wake(other);
      applied(item);
    };
    const auto lost = [&](const Item& item) { run_plainly(std::span(&item, 1), 0, 1, applied); };
    const auto item_at = [&](std::size_t i) -> Item { return work[begin + i]; };
    windows_->run(end - begin, item_at, won, lost);
  }

  const Executor& executor_;
  Op& op_;
  RoundsReport& report_;
  Commit commit_;
  Sharing sharing_;
  FasterWay faster_;
  std::optional<Windows> windows_;
  Plan plan_{};  // keeps its memory from part to part
};

/// Runs all of the work, which has size() and operator[], by the strategy in_order, where no item
/// may be woken. Calls applied(item) for each applied item, in the order of the work.
template <Operator Op>
RoundsReport run_in_order(const Executor& executor, Op& op, const auto& work, auto&& applied,
                          Sharing sharing = Sharing::where_faster) {
  RoundsReport report{.rounds = 1};
  const auto refuse = [](const typename Op::Item&) {
    throw std::logic_error(
        "strategy in_order: an item was woken, but only the work itself has an order");
  };
  OrderedRun(executor, op, report, refuse, sharing).run(work, applied);
  return report;
}

}  // namespace ductile::runtime::detail
