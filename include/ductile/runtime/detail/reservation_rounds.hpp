/// @file
/// ReservationRounds: the strategy `reservations`, in windows of the work. The share of losers
/// determines the size of the next window; losers and woken items are the next pass's work. Without
/// priorities, the items of a window are far apart in the work.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/detail/reservation_windows.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

template <Operator Op>
class ReservationRounds {
 public:
  using Item = typename Op::Item;
  using Windows = ReservationWindows<Op, RankedOperator<Op>>;

  ReservationRounds(const Executor& executor, Op& op, std::uint32_t highest_key = Windows::nobody)
      : windows_(executor, op, report_, highest_key) {}

  RoundsReport run(std::vector<Item> work, std::size_t most_passes) {
    while (!work.empty() && report_.rounds < most_passes) {
      ++report_.rounds;
      if constexpr (RankedOperator<Op>) {
        run_pass(work, [](std::size_t i) { return i; });
      } else {
        run_pass(work, Strides(work.size(), window_));
      }
      work.swap(lost_);
      lost_.clear();
      work.insert(work.end(), woken_.begin(), woken_.end());
      woken_.clear();
    }
    report_.left = work.size();
    windows_.close_holes();
    return report_;
  }

 private:
  static constexpr std::size_t least_window = 64, first_window = 2048;

  /// The order 0, k, 2 k, ..., 1, 1 + k, ... of n places, for k of about n / window: items that are
  /// far apart in the work seldom touch.
  class Strides {
   public:
    Strides(std::size_t n, std::size_t window)
        : step_((n + window - 1) / window), each_(n / step_), longer_(n % step_) {}
    std::size_t operator()(std::size_t i) const {
      const std::size_t in_longer = longer_ * (each_ + 1);
      if (i < in_longer) return i % (each_ + 1) * step_ + i / (each_ + 1);
      return (i - in_longer) % each_ * step_ + longer_ + (i - in_longer) / each_;
    }

   private:
    std::size_t step_, each_, longer_;
  };

  void run_pass(const std::vector<Item>& work, auto&& place_at) {
    const auto won = [&](const Item&, std::span<const Item> woken) {
      woken_.insert(woken_.end(), woken.begin(), woken.end());
    };
    const auto lost = [&](const Item& item) { lost_.push_back(item); };
    for (std::size_t at = 0; at < work.size();) {
      const std::size_t count = std::min(window_, work.size() - at);
      const RoundsReport before = report_;
      windows_.run(
          count, [&](std::size_t i) -> const Item& { return work[place_at(at + i)]; }, won, lost);
      resize_window(report_.applied - before.applied, report_.lost - before.lost);
      at += count;
    }
  }

  void resize_window(std::size_t won, std::size_t lost) {
    if (4 * lost > won) window_ = std::max(least_window, window_ / 2);
    if (16 * lost < won) window_ = std::min(Windows::most_items, window_ * 2);
  }

  RoundsReport report_;
  Windows windows_;
  std::size_t window_ = first_window;
  std::vector<Item> lost_, woken_;
};

}  // namespace ductile::runtime::detail
