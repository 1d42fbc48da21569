/// @file
/// ReservingRounds: finds items that may run together by reservations, for operators of which few
/// items act: the highest priority on all of its footprint runs, the others wait for the next
/// round.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <vector>

#include "ductile/runtime/atomic_count.hpp"
#include "ductile/runtime/atomic_min.hpp"
#include "ductile/runtime/detail/batches.hpp"
#include "ductile/runtime/detail/filled_array.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/phase_timer.hpp"

namespace ductile::runtime::detail {

template <class Op, class Check>
class ReservingRounds {
 public:
  using Item = typename Op::Item;

  explicit ReservingRounds(Batches<Op, Check>& batches) : batches_(batches) {}

  /// Goes over the work window by window, so that what is reserved, planned and applied one after
  /// the other stays in cache. Returns the work of the next round.
  std::vector<Item> run(std::vector<Item> work) {
    std::vector<Item> rest;
    const std::size_t largest = Check::on ? 0 : batches_.options.reserving_window;
    for_each_window(std::span(work), window_count(work.size(), largest),
                    [&](std::span<Item> part) { reserve_and_run(part, rest); });
    std::vector<Item> woken = batches_.take_woken();
    append(rest, woken);
    return rest;
  }

 private:
  static constexpr std::uint8_t gone = 0, waits = 1, runs = 2, passes = 4;
  static constexpr std::uint32_t everyone = 0xffffffffU, last_window = 0xffffffU;

  static void append(std::vector<Item>& to, std::vector<Item>& items) {
    to.insert(to.end(), std::make_move_iterator(items.begin()),
              std::make_move_iterator(items.end()));
  }

  /// Runs the items of a window that win, and appends those that have to wait to `rest`.
  void reserve_and_run(std::span<Item> work, std::vector<Item>& rest) {
    // Where the numbers of windows in keys begin anew, what was reserved is forgotten.
    if ((++window_ & last_window) == 0) reserved_ = {};
    std::vector<std::uint8_t> outcome(work.size());
    {
      const PhaseTimer timer(batches_.report.conflict_seconds, executor_, Phase::conflict);
      reserved_.resize(executor_, op_.resource_count(), ~std::uint64_t{0});
      if (!executor_.deterministic()) ticket_of_.resize(work.size());
      parallel_for_blocks(
          executor_, work.size(), short_block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              outcome[i] = asks(i) ? reserve(work[i], i) : passes;
          },
          by_block);
      parallel_for_blocks(
          executor_, work.size(), short_block,
          [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
              if (outcome[i] == waits && holds_all(work[i], i)) outcome[i] = runs;
          },
          by_block);
    }
    const std::vector<Item> winners = select(executor_, work, outcome, runs);
    std::vector<Item> losers = select(executor_, work, outcome, waits | passes);
    const std::size_t lost = losers.size() - (share_ < everyone ? count(outcome, passes) : 0);
    batches_.report.lost += lost;
    adapt_share(winners.size(), lost);
    batches_.run(
        winners, [](const Item&) { return true; }, [&] { return batches_.new_commit(window_); });
    append(rest, losers);
  }

  /// Whether the item at this position asks for its footprint in this window.
  bool asks(std::size_t position) const {
    if (share_ == everyone) return true;
    return mix32(static_cast<std::uint32_t>(position) ^ (window_ * 0x85ebca6bU)) <= share_;
  }

  /// Fewer ask in the next window if too few of those that asked won, and more if most did.
  void adapt_share(std::size_t won, std::size_t lost) {
    const double least_won = batches_.options.least_won;
    const double asked = static_cast<double>(won + lost), wanted = least_won * asked;
    if (won + lost < short_block || static_cast<double>(won) > (asked + wanted) / 2) {
      share_ = share_ > everyone / 2 ? everyone : 2 * share_ + 1;
    } else if (static_cast<double>(won) < wanted) {
      share_ /= 2;
    }
  }

  std::size_t count(const std::vector<std::uint8_t>& outcome, std::uint8_t wanted) const {
    const auto one_if_wanted = [&](std::size_t i) -> std::size_t { return outcome[i] == wanted; };
    return parallel_reduce(executor_, outcome.size(), std::size_t{0}, one_if_wanted, std::plus<>());
  }

  /// A later window always has the lower key, so reservations never have to be cleared.
  std::uint64_t key_of(const Item& item, std::size_t position) const {
    std::uint64_t rank = 0;
    if constexpr (RankedOperator<Op>) rank = op_.priority(item);
    const auto place = static_cast<std::uint32_t>(position);
    const std::uint32_t tie =
        executor_.deterministic() ? mix32(place ^ (window_ * 0x9e3779b9U)) : ticket_of_[position];
    return (std::uint64_t{~window_ & last_window} << 40U) | (rank << 32U) | tie;
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

  bool holds_all(const Item& item, std::size_t position) const {
    const std::uint64_t key = key_of(item, position);
    bool all = true;
    op_.footprint(item, [&](std::uint32_t resource) { all = all && reserved_[resource] == key; });
    return all;
  }

  Batches<Op, Check>& batches_;
  const Executor& executor_ = batches_.executor;
  Op& op_ = batches_.op;
  FilledArray<std::uint64_t> reserved_;   // [resource], the lowest key that asked
  std::vector<std::uint32_t> ticket_of_;  // [position], racing mode: order of arrival
  std::uint32_t ticket_ = 0;
  std::uint32_t share_ = everyone;  // who has a hash up to this asks
  std::uint32_t window_ = 0;        // the window being run
};

}  // namespace ductile::runtime::detail
