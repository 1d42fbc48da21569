/// @file
/// LevelRounds: the strategy `reservations` for operators with levels. A round consists of all
/// present items of the lowest level; items they wake come later. Parts of a round are run by a
/// plain loop or by several threads, whichever has been faster so far; the result is the same.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ductile/runtime/detail/ordered_windows.hpp"
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

/// Tests use `always`.
enum class Sharing : std::uint8_t { where_faster, always };

template <LevelledOperator Op>
class LevelRounds {
 public:
  using Item = typename Op::Item;
  using Plan = typename Op::Plan;

  LevelRounds(const Executor& executor, Op& op, Sharing sharing = Sharing::where_faster)
      : executor_(executor), op_(op), sharing_(sharing), waiting_(op) {}

  RoundsReport run(const std::vector<Item>& work, std::size_t most_rounds) {
    for (const Item& item : work) waiting_.add(item);
    while (report_.rounds < most_rounds && waiting_.take_lowest(round_)) {
      ++report_.rounds;
      if (sharing_ == Sharing::always) {
        run_at_once(0, round_.size());
      } else if (executor_.threads() == 1) {
        run_plainly(0, round_.size());
      } else {
        run_shared();
      }
    }
    report_.left = waiting_.size();
    return report_;
  }

 private:
  using Windows = OrderedWindows<Op, std::vector<Item>>;
  static constexpr std::size_t part = 16384, tried_often = 32, tried_seldom = 512;
  static constexpr double too_short_to_share = 8000;  // nanoseconds

  struct PlainCommit {
    ItemsByLevel<Op>& waiting;
    void wake(const Item& item) { waiting.add(item); }
  };
  struct NotingCommit {
    std::vector<Item>& woken;
    void wake(const Item& item) { woken.push_back(item); }
  };

  /// Tries both ways from time to time, ever less often while the same one wins.
  void run_shared() {
    for (std::size_t begin = 0; begin < round_.size(); begin += part) {
      const std::size_t end = std::min<std::size_t>(begin + part, round_.size());
      const auto items = static_cast<double>(end - begin);
      if (items * plain_ < too_short_to_share) {
        plain_ = timed([&] { run_plainly(begin, end); }) / items;
        continue;
      }
      if (trial_ == 0 && --until_trial_ == 0) begin_trial();
      const bool is_at_once = trial_ > 0 ? trial_ % 2 == 0 : at_once_wins_;
      double& best = is_at_once ? best_at_once_ : best_plain_;
      if (is_at_once) {
        best = std::min(best, timed([&] { run_at_once(begin, end); }) / items);
      } else {
        plain_ = timed([&] { run_plainly(begin, end); }) / items;
        best = std::min(best, plain_);
      }
      if (trial_ > 0 && --trial_ == 0) end_trial();
    }
  }

  void begin_trial() {
    trial_ = 6;  // the best of three parts each, because other programs may use the cores meanwhile
    best_plain_ = best_at_once_ = std::numeric_limits<double>::max();
  }
  void end_trial() {
    const bool wins = best_at_once_ < best_plain_;
    tried_every_ = wins == at_once_wins_ ? std::min(2 * tried_every_, tried_seldom) : tried_often;
    until_trial_ = tried_every_;
    at_once_wins_ = wins;
  }

  /// Runs it; returns nanoseconds.
  static double timed(auto&& run) {
    const auto start = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start)
        .count();
  }

  void run_plainly(std::size_t begin, std::size_t end) {
    ReachAll reach;
    PlainCommit commit{waiting_};
    report_.planned += end - begin;
    for (std::size_t i = begin; i < end; ++i) {
      const Item item = round_[i];
      if (!op_.plan(item, plan_, reach)) continue;
      op_.apply(item, plan_, commit);
      ++report_.applied;
    }
  }

  void run_at_once(std::size_t begin, std::size_t end) {
    if (!at_once_windows_) at_once_windows_.emplace(executor_, op_, round_);
    const auto apply = [&](const Item& item, Plan& plan, std::vector<Item>& woken) {
      NotingCommit commit{woken};
      op_.apply(item, plan, commit);
    };
    const auto wake = [&](std::span<const Item> woken) {
      for (const Item& item : woken) waiting_.add(item);
    };
    at_once_windows_->run_waking(begin, end, WindowSteps{apply, TellNobody(), wake}, report_);
  }

  const Executor& executor_;
  Op& op_;
  Sharing sharing_;
  ItemsByLevel<Op> waiting_;
  std::vector<Item> round_;
  std::optional<Windows> at_once_windows_;
  Plan plan_{};
  double plain_ = 0;                          // nanoseconds per item, the last time it was used
  double best_plain_ = 0, best_at_once_ = 0;  // in a trial
  bool at_once_wins_ = false;
  std::size_t trial_ = 0;  // parts left in the current trial
  std::size_t until_trial_ = 1, tried_every_ = tried_often;
  RoundsReport report_;
};

}  // namespace ductile::runtime::detail
