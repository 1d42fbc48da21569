/// @file
/// SplitIntervals: an Operator for tests, with faults that can be switched on. A row of intervals
/// covers [0, 1); each is halved until it is short enough. Makes intervals and points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::test {

/// Faults of the operator that a test can switch on.
struct IntervalFaults {
  bool writes_unreached = false, reads_unreached = false, goes_on = false;
  std::uint32_t demanded = 1;  // of points for each interval; no fault
  bool takes_too_many = false, out_of_range = false, reuses_plan = false, reaches_nothing = false;
};

/// The row lies along a line in Dim dimensions.
template <std::size_t Dim>
class SplitIntervals {
 public:
  static constexpr std::uint32_t none = 0xffffffffU;
  struct Interval {
    std::uint32_t first_point, end_point, left, right;
  };
  struct Item {
    std::uint32_t interval, end_point;  // void if the interval has got another end
    friend bool operator==(const Item&, const Item&) = default;
  };
  struct Plan {
    double middle = 0;
    std::uint32_t left = none, right = none, seen = none;
    friend bool operator==(const Plan&, const Plan&) = default;
  };

  /// `count` intervals of random lengths, in a random order of numbers.
  SplitIntervals(std::size_t count, double length, IntervalFaults faults = {})
      : intervals(count), points(count + 1), length_(length), faults_(faults) {
    std::vector<std::uint32_t> number(count);
    for (std::uint32_t i = 0; i < count; ++i) number[i] = i;
    for (std::size_t i = count; i > 1; --i) std::swap(number[i - 1], number[mix64(i) % i]);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double jump = static_cast<double>(mix64(i) % 1000) / 1000;
      points[i + 1] = i + 1 == count ? 1 : (i + jump) / static_cast<double>(count);
      intervals[number[i]] = {i, i + 1, i == 0 ? none : number[i - 1],
                              i + 1 == count ? none : number[i + 1]};
    }
    first = count == 0 ? none : number[0];
  }

  std::vector<Item> all_items() const {
    std::vector<Item> items;
    for (std::uint32_t i = 0; i < intervals.size(); ++i)
      items.push_back({i, intervals[i].end_point});
    return items;
  }

  std::size_t resource_count() const { return intervals.size(); }
  std::array<double, Dim> place_of(std::uint32_t interval) const {
    std::array<double, Dim> place;
    place.fill(points[intervals[interval].first_point]);
    return place;
  }

  bool plan(const Item& item, Plan& plan, auto& reach) const {
    if (faults_.out_of_range) reach(1000000000U);
    if (!faults_.reaches_nothing && !reach(item.interval) && !faults_.goes_on) return false;
    const Interval& interval = intervals[item.interval];
    if (interval.end_point != item.end_point || length_of(item.interval) <= length_) return false;
    if (faults_.reuses_plan && plan.middle > 0.5) return false;
    plan.middle = (points[interval.first_point] + points[interval.end_point]) / 2;
    plan.left = interval.left;
    plan.right = interval.right;
    if (faults_.reads_unreached) plan.seen = end_after(plan.right);
    if (faults_.writes_unreached || faults_.reaches_nothing || plan.right == none) return true;
    return reach(plan.right) || faults_.goes_on;
  }

  /// The new interval is the right half, as the interval keeps its first point.
  void apply(const Item& item, Plan& plan, auto& commit) {
    const std::uint32_t half = commit.fresh(0), point = commit.fresh(1);
    if (faults_.takes_too_many) commit.fresh(1);
    Interval& interval = intervals[item.interval];
    points[point] = plan.middle;
    intervals[half] = {point, interval.end_point, item.interval, plan.right};
    interval.end_point = point;
    interval.right = half;
    if (plan.right != none) intervals[plan.right].left = half;
    commit.wake({item.interval, point});
    commit.wake({half, intervals[half].end_point});
  }

  std::array<std::size_t, 2> counts() const { return {intervals.size(), points.size()}; }
  std::array<std::size_t, 2> demand(const Plan&) const { return {1, faults_.demanded}; }
  void grow(const std::array<std::size_t, 2>& room) {
    intervals.resize(room[0]);
    points.resize(room[1]);
  }
  void renumber(std::size_t kind, std::span<const Renumbered> moved, std::size_t count) {
    if (kind == 0) {
      for (const auto [from, to] : moved) move_interval(from, to);
      intervals.resize(count);
    } else {
      std::vector<std::uint32_t> now_of(points.size());
      std::iota(now_of.begin(), now_of.end(), 0U);
      for (const auto [from, to] : moved) points[now_of[from] = to] = points[from];
      for (Interval& interval : intervals) {
        interval.first_point = now_of[interval.first_point];
        interval.end_point = now_of[interval.end_point];
      }
      points.resize(count);
    }
  }

  /// Does the row contain every interval once, each next to the previous one, and none too long?
  bool is_whole() const {
    std::size_t seen = 0;
    std::uint32_t left = none, last_point = none;
    for (std::uint32_t at = first; at != none; left = at, at = intervals[at].right) {
      const Interval& interval = intervals[at];
      if (++seen > intervals.size() || interval.left != left || length_of(at) > length_)
        return false;
      if (left != none && interval.first_point != last_point) return false;
      last_point = interval.end_point;
    }
    return seen == intervals.size() && points.size() == seen + 1;
  }

  std::uint64_t hash() const {
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < intervals.size(); ++i) {
      const Interval& interval = intervals[i];
      sum = mix64(sum ^ interval.first_point ^ (std::uint64_t{interval.right} << 32U)) +
            mix64(static_cast<std::uint64_t>(points[interval.end_point] * 0x1p52));
    }
    return sum;
  }

  std::vector<Interval> intervals;
  std::vector<double> points;
  std::uint32_t first = none;

 private:
  void move_interval(std::uint32_t from, std::uint32_t to) {
    intervals[to] = intervals[from];
    if (from == first) first = to;
    if (intervals[to].left != none) intervals[intervals[to].left].right = to;
    if (intervals[to].right != none) intervals[intervals[to].right].left = to;
  }
  /// Right end of the interval to the right of this one.
  std::uint32_t end_after(std::uint32_t interval) const {
    if (interval == none || intervals[interval].right == none) return none;
    return intervals[intervals[interval].right].end_point;
  }
  double length_of(std::uint32_t interval) const {
    return points[intervals[interval].end_point] - points[intervals[interval].first_point];
  }

  double length_;
  IntervalFaults faults_;
};

}  // namespace ductile::runtime::test
