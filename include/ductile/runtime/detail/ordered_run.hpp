/// @file
/// run_in_order: the strategy `in_order`. Parts of the work are run by a plain loop or by several
/// threads, whichever has been faster so far; the result is the same.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include "ductile/runtime/detail/ordered_stream.hpp"
#include "ductile/runtime/detail/ordered_windows.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// apply()'s argument in the strategy in_order, where no item may be woken.
template <class Item>
struct OrderedCommit {
  void wake(const Item&) const {
    throw std::logic_error(
        "strategy in_order: an item was woken, but only the work itself has an order");
  }
  void postpone(const Item& item) const { wake(item); }
};

/// The engine that runs a part of the work on several threads.
template <class Op, class Work>
struct AtOnceOf {
  using Type = OrderedWindows<Op, Work>;
};
template <ConflictingOperator Op, class Work>
struct AtOnceOf<Op, Work> {
  using Type = OrderedStream<Op, Work>;
};

/// One run. Work has size() and operator[].
template <Operator Op, class Work>
class OrderedRun {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  OrderedRun(const Executor& executor, Op& op, const Work& work)
      : executor_(executor), op_(op), work_(work) {}

  /// Calls applied(item) for each applied item, in the order of the work.
  RoundsReport run(auto&& applied) {
    if (executor_.threads() == 1) {
      run_plainly(0, work_.size(), applied);
      return report_;
    }
    double plain = 0, at_once = 0;  // nanoseconds per item
    for (std::size_t begin = 0, number = 0; begin < work_.size(); begin += part, ++number) {
      const std::size_t end = std::min<std::size_t>(begin + part, work_.size());
      const std::size_t turn = number % tried_every;
      // The plain loop runs twice, because its first part may have to fetch memory.
      const bool is_plain_turn = turn != 1 && (turn <= 2 || plain < at_once);
      const bool is_plain = is_plain_turn || plain < too_fast_to_share;
      const auto start = std::chrono::steady_clock::now();
      if (is_plain) {
        run_plainly(begin, end, applied);
      } else {
        run_at_once(begin, end, applied);
      }
      const std::chrono::duration<double, std::nano> time =
          std::chrono::steady_clock::now() - start;
      (is_plain ? plain : at_once) = time.count() / static_cast<double>(end - begin);
    }
    return report_;
  }

 private:
  using AtOnce = typename AtOnceOf<Op, Work>::Type;
  static constexpr std::size_t part = 65536, tried_every = 16;
  static constexpr double too_fast_to_share = 8;  // nanoseconds two cores need to share an item

  void run_plainly(std::size_t begin, std::size_t end, auto&& applied) {
    Plan plan{};
    ReachAll reach;
    report_.planned += end - begin;
    for (std::size_t i = begin; i < end; ++i) {
      const Item item = work_[i];
      if (!op_.plan(item, plan, reach)) continue;
      op_.apply(item, plan, commit_);
      applied(item);
      ++report_.applied;
    }
  }

  void run_at_once(std::size_t begin, std::size_t end, auto&& applied) {
    if (!at_once_) at_once_.emplace(executor_, op_, work_);
    const auto apply = [&](const Item& item, Plan& plan) { op_.apply(item, plan, commit_); };
    at_once_->run(begin, end, apply, applied, report_);
  }

  const Executor& executor_;
  Op& op_;
  const Work& work_;
  OrderedCommit<Item> commit_;
  std::optional<AtOnce> at_once_;
  RoundsReport report_{.rounds = 1};
};

/// Runs all of the work, which has size() and operator[]. Calls applied(item) for each applied
/// item, in the order of the work.
template <Operator Op, class Work>
RoundsReport run_in_order(const Executor& executor, Op& op, const Work& work, auto&& applied) {
  return OrderedRun<Op, Work>(executor, op, work).run(applied);
}

}  // namespace ductile::runtime::detail
