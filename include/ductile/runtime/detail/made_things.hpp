/// @file
/// MadeThings: the numbers of all things that an operator makes, dealt to the parts of a run and
/// made contiguous again afterwards. Empty for operators that make nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/numbers.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// The new numbers of one item, [next, end) of each kind.
template <std::size_t kinds>
struct NewNumbers {
  std::array<std::uint32_t, kinds> next{}, end{};

  /// Throws std::logic_error if there is none.
  std::uint32_t take(std::size_t kind) requires(kinds > 0) {
    if (next[kind] == end[kind]) [[unlikely]]
      throw std::logic_error("apply() takes more fresh numbers than demand() asked for");
    return next[kind]++;
  }
};

/// Thread safety: one caller.
template <class Op>
class MadeThings {
 public:
  static constexpr std::size_t kinds = kinds_made<Op>;
  using Pools = std::array<NumberPool, kinds>;
  using New = NewNumbers<kinds>;

  explicit MadeThings(Op& op) : op_(op) {
    if constexpr (kinds > 0) {
      const auto counts = op.counts();
      for (std::size_t k = 0; k < kinds; ++k) numbers_[k] = Numbers(room_[k] = counts[k]);
    } else {
      resources_ = Numbers(op.resource_count());
    }
  }

  const Numbers& resources() const {
    if constexpr (kinds > 0) {
      return numbers_[0];
    } else {
      return resources_;
    }
  }

  /// Adds numbers of each kind to each part's pools, and makes room for them.
  void deal(std::size_t parts, auto&& pools_of, auto&& wanted_by) {
    if constexpr (kinds > 0) {
      std::vector<NumberPool> pools(parts);
      for (std::size_t k = 0; k < kinds; ++k) {
        for (std::size_t p = 0; p < parts; ++p) pools[p] = std::move(pools_of(p)[k]);
        numbers_[k].deal(pools, wanted_by);
        for (std::size_t p = 0; p < parts; ++p) pools_of(p)[k] = std::move(pools[p]);
      }
      make_room();
    }
  }

  /// Gives each acting slot the new numbers that its plan demands: visit(number) calls number(slot)
  /// for these slots, in order. Is called twice.
  void number(auto&& visit) requires(kinds > 0) {
    std::array<std::size_t, kinds> more{}, first{};
    visit([&](auto& slot) {
      const auto wanted = op_.demand(slot.plan);
      for (std::size_t k = 0; k < kinds; ++k) {
        slot.fresh.next[k] = static_cast<std::uint32_t>(more[k]);
        more[k] += wanted[k];
        slot.fresh.end[k] = static_cast<std::uint32_t>(more[k]);
      }
    });
    for (std::size_t k = 0; k < kinds; ++k) first[k] = numbers_[k].extend(more[k]);
    make_room();
    visit([&](auto& slot) {
      for (std::size_t k = 0; k < kinds; ++k) {
        slot.fresh.next[k] += static_cast<std::uint32_t>(first[k]);
        slot.fresh.end[k] += static_cast<std::uint32_t>(first[k]);
      }
    });
  }

  /// Returns numbers that were reserved but not used.
  void take_back(const New& numbers) {
    for (std::size_t k = 0; k < kinds; ++k) not_taken_[k].add({numbers.next[k], numbers.end[k]});
  }

  void take_back(std::size_t parts, auto&& pools_of) {
    if constexpr (kinds > 0) {
      std::vector<NumberPool> pools(parts);
      for (std::size_t k = 0; k < kinds; ++k) {
        for (std::size_t p = 0; p < parts; ++p) pools[p] = std::move(pools_of(p)[k]);
        numbers_[k].take_back(pools);
      }
    }
  }

  /// Renumbers so that no number is unused, and tells the operator.
  void close_holes() {
    if constexpr (kinds > 0)
      for (std::size_t k = 0; k < kinds; ++k) {
        numbers_[k].take_back({&not_taken_[k], 1});
        const std::vector<Renumbered> moved = numbers_[k].close_holes();
        op_.renumber(k, std::span<const Renumbered>(moved), numbers_[k].top());
      }
  }

 private:
  void make_room() {
    bool has_room = true;
    for (std::size_t k = 0; k < kinds; ++k) {
      has_room = has_room && numbers_[k].top() <= room_[k];
      room_[k] = std::max(room_[k], numbers_[k].top());
    }
    if (!has_room) op_.grow(room_);
  }

  Op& op_;
  std::array<Numbers, kinds> numbers_;
  std::array<std::size_t, kinds> room_{};
  Pools not_taken_;
  Numbers resources_;  // used if nothing is made
};

/// Do the pools have enough numbers for a plan?
template <class Op>
bool has_room(const Op& op, const auto& pools, const typename Op::Plan& plan) {
  if constexpr (kinds_made<Op> != 0) {
    const auto wanted = op.demand(plan);
    for (std::size_t k = 0; k < pools.size(); ++k)
      if (pools[k].left() < wanted[k]) return false;
  }
  return true;
}

}  // namespace ductile::runtime::detail
