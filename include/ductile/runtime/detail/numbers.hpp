/// @file
/// Numbers of the things of one kind that an operator makes. Numbers in use lie below `top`, except
/// for unused ranges: dealt to parts of a run, but not needed there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

struct NumberRange {
  std::uint32_t begin, end;
};

/// Numbers that one part of a run may take.
class NumberPool {
 public:
  std::size_t left() const { return left_; }
  /// Takes the lowest number. Throws std::logic_error if there is none.
  std::uint32_t take() {
    if (left_ == 0) [[unlikely]]
      throw std::logic_error("apply() takes more fresh numbers than demand() asked for");
    NumberRange& range = ranges_.back();
    const std::uint32_t number = range.begin++;
    if (range.begin == range.end) ranges_.pop_back();
    --left_;
    return number;
  }
  /// Add ranges in falling order if numbers will be taken.
  void add(NumberRange range) {
    if (range.begin == range.end) return;
    ranges_.push_back(range);
    left_ += range.end - range.begin;
  }
  std::span<const NumberRange> ranges() const { return ranges_; }

 private:
  std::vector<NumberRange> ranges_;  // falling
  std::size_t left_ = 0;
};

/// Thread safety: one caller.
class Numbers {
 public:
  explicit Numbers(std::size_t count = 0) : top_(count) {}

  std::size_t top() const { return top_; }
  std::size_t used() const { return top_ - unused_count_; }

  /// Calls visit(begin, end) for each range in use, in rising order.
  void for_each_used(auto&& visit) const {
    std::uint32_t at = 0;
    for (const NumberRange hole : unused_) {
      if (at < hole.begin) visit(at, hole.begin);
      at = hole.end;
    }
    if (at < top_) visit(at, static_cast<std::uint32_t>(top_));
  }

  /// Deals numbers to each pool: first unused ones, ascending, then new ones. Throws
  /// std::length_error if there are no more below 2^32 - 1.
  void deal(std::span<NumberPool> pools, auto&& wanted_by) {
    std::size_t next = 0;
    for (std::size_t p = 0; p < pools.size(); ++p) {
      std::vector<NumberRange> ranges;
      std::size_t wanted = wanted_by(p);
      while (wanted > 0 && next < unused_.size()) {
        NumberRange& hole = unused_[next];
        const auto n =
            static_cast<std::uint32_t>(std::min<std::size_t>(wanted, hole.end - hole.begin));
        ranges.push_back({hole.begin, hole.begin + n});
        hole.begin += n;
        unused_count_ -= n;
        wanted -= n;
        if (hole.begin == hole.end) ++next;
      }
      if (wanted > 0) {
        const std::size_t end = top_ + wanted;
        expect_numbers(end);
        ranges.push_back({static_cast<std::uint32_t>(top_), static_cast<std::uint32_t>(end)});
        top_ = end;
      }
      for (std::size_t i = ranges.size(); i-- > 0;) pools[p].add(ranges[i]);
    }
    unused_.erase(unused_.begin(), unused_.begin() + static_cast<std::ptrdiff_t>(next));
  }

  /// Takes `more` new numbers and returns the first. Throws std::length_error.
  std::size_t extend(std::size_t more) {
    expect_numbers(top_ + more);
    return std::exchange(top_, top_ + more);
  }

  /// Marks what is left in the pools as unused.
  void take_back(std::span<const NumberPool> pools) {
    for (const NumberPool& pool : pools) {
      unused_.insert(unused_.end(), pool.ranges().begin(), pool.ranges().end());
      unused_count_ += pool.left();
    }
    join_unused();
  }

  /// Moves the last things to unused numbers until the numbers in use are contiguous.
  std::vector<Renumbered> close_holes() {
    std::vector<Renumbered> moved;
    const std::size_t count = used();
    std::size_t hole = 0, to = 0;
    const auto next_unused = [&] {
      for (; hole < unused_.size(); ++hole, to = 0) {
        to = std::max<std::size_t>(to, unused_[hole].begin);
        if (to < unused_[hole].end) return static_cast<std::uint32_t>(to++);
      }
      return static_cast<std::uint32_t>(top_);
    };
    for_each_used([&](std::uint32_t begin, std::uint32_t end) {
      for (std::size_t from = std::max<std::size_t>(begin, count); from < end; ++from)
        moved.push_back({static_cast<std::uint32_t>(from), next_unused()});
    });
    top_ = count;
    unused_.clear();
    unused_count_ = 0;
    return moved;
  }

 private:
  static void expect_numbers(std::size_t end) {
    if (end >= 0xffffffffU) throw std::length_error("things have numbers of 32 bits");
  }

  void join_unused() {
    std::sort(unused_.begin(), unused_.end(),
              [](NumberRange a, NumberRange b) { return a.begin < b.begin; });
    std::size_t n = 0;
    for (const NumberRange range : unused_) {
      if (n > 0 && unused_[n - 1].end == range.begin) {
        unused_[n - 1].end = range.end;
      } else {
        unused_[n++] = range;
      }
    }
    unused_.resize(n);
    if (n > 0 && unused_.back().end == top_) {
      top_ = unused_.back().begin;
      unused_count_ -= unused_.back().end - unused_.back().begin;
      unused_.pop_back();
    }
  }

  std::size_t top_, unused_count_ = 0;
  std::vector<NumberRange> unused_;  // rising, neither empty nor adjoining
};

}  // namespace ductile::runtime::detail
