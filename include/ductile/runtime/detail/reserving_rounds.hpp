/// @file
/// ReservingRounds: finds items that may run together by reservations, for operators of which few
/// items act: the highest priority on all of its footprint runs, the others wait for the next
/// round.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/detail/batches.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime::detail {

template <class Op, class Check>
class ReservingRounds {
 public:
  using Item = typename Op::Item;

  explicit ReservingRounds(Batches<Op, Check>& batches) : batches_(batches) {}

  /// Goes over the work window by window, so that what is reserved, planned and applied one after
  /// the other stays in cache. Returns the work of the next round.
  UnsetVector<Item> run(auto work) {
    UnsetVector<Item> rest;
    rest.reserve(work.size());
    const std::size_t wanted = Check::on ? 0 : batches_.options.reserving_window;
    const std::size_t largest = wanted == 0 ? most_items : std::min(wanted, most_items);
    for_each_window(std::span<Item>(work), window_count(work.size(), largest),
                    [&](std::span<Item> part) { reserve_and_run(part, rest); });
    UnsetVector<Item> woken = batches_.take_woken();
    rest.insert(rest.end(), std::make_move_iterator(woken.begin()),
                std::make_move_iterator(woken.end()));
    return rest;
  }

 private:
  static constexpr unsigned rank_bits = RankedOperator<Op> ? 8 : 0;
  static constexpr std::uint64_t all_keys = std::uint64_t{1} << 32U;
  static constexpr std::size_t most_items = std::size_t{1} << 24U;  // of a window, with their ranks
  static constexpr std::uint32_t everyone = 0xffffffffU;

  /// What becomes of an item of a window.
  enum class Outcome : std::uint8_t { gone, runs, lost, passes };
  /// Of the items of a block, or of those before it.
  struct Counts {
    std::size_t run = 0, lost = 0, left = 0;
  };

  /// Items that a thread looks at in one go: fewer of a small window, so that each of many threads
  /// gets some.
  static std::size_t block_of(std::size_t items) {
    return std::clamp<std::size_t>(items / 512, 4, short_block);
  }

  /// Few items are looked at before other threads would have begun.
  static LoopOptions by_block_unless_few(std::size_t items) {
    constexpr std::size_t few = 32;
    return {.grain = 1, .serial_below = std::max(by_block.serial_below, few / block_of(items))};
  }

  /// Runs the items of a window that win, and appends those that have to wait to `rest`.
  void reserve_and_run(std::span<Item> work, UnsetVector<Item>& rest) {
    {
      const PhaseTimer timer(batches_.report.conflict_seconds);
      ++window_;
      take_keys(work.size());
      reserve_all(work);
      take_winners(work, rest);
    }
    batches_.run(
        std::span<const Item>(winners_), all_are_here, [](const Item&) {},
        [&] { return batches_.new_commit(window_); }, [] {});
  }

  /// A later window has lower keys, so that reservations never have to be cleared but where there
  /// are no keys left.
  void take_keys(std::size_t items) {
    tie_bits_ = static_cast<unsigned>(std::bit_width(items - 1));
    const std::uint64_t wanted = std::uint64_t{1} << (rank_bits + tie_bits_);
    if (wanted > first_key_) {
      reserved_.clear();
      first_key_ = all_keys;
    }
    first_key_ -= wanted;
    grow_filled(executor_, reserved_, op_.resource_count(), ~std::uint32_t{0});
  }

  void reserve_all(std::span<const Item> work) {
    key_of_.resize(work.size());
    outcome_of_.resize(work.size());
    ticket_ = 0;
    parallel_for_blocks(
        executor_, work.size(), block_of(work.size()),
        [&](std::size_t, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            if (share_ == everyone) prefetch_items_after<Op>(op_, work, i, all_are_here);
            outcome_of_[i] = asks(i) ? reserve(work[i], i) : Outcome::passes;
          }
        },
        by_block_unless_few(work.size()));
  }

  /// Finds out who holds all of its footprint; moves those to winners_, and those that have to wait
  /// to `rest`, in order.
  void take_winners(std::span<Item> work, UnsetVector<Item>& rest) {
    const std::size_t block = block_of(work.size());
    counts_of_.resize((work.size() + block - 1) / block);
    parallel_for_blocks(
        executor_, work.size(), block,
        [&](std::size_t b, std::size_t begin, std::size_t end) {
          Counts found;
          for (std::size_t i = begin; i < end; ++i) {
            if (share_ == everyone) prefetch_items_after<Op>(op_, work, i, all_are_here);
            settle(work[i], i, found);
          }
          counts_of_[b] = found;
        },
        by_block_unless_few(work.size()));
    if constexpr (Check::on)  // they have had their turn
      for (std::size_t i = 0; i < work.size(); ++i)
        if (outcome_of_[i] == Outcome::gone) batches_.check.note_void(work[i]);
    Counts total{.left = rest.size()};
    for (Counts& count : counts_of_)
      total = {total.run + std::exchange(count.run, total.run), total.lost + count.lost,
               total.left + std::exchange(count.left, total.left)};
    winners_.resize(total.run);
    rest.resize(total.left);
    parallel_for_blocks(executor_, work.size(), block,
                        [&](std::size_t b, std::size_t begin, std::size_t end) {
                          Counts at = counts_of_[b];
                          for (std::size_t i = begin; i < end; ++i) {
                            if (outcome_of_[i] == Outcome::runs)
                              winners_[at.run++] = std::move(work[i]);
                            if (is_left(outcome_of_[i])) rest[at.left++] = std::move(work[i]);
                          }
                        },
                        {.grain = 4, .serial_below = 2048 / block});
    batches_.report.lost += total.lost;
    adapt_share(total.run, total.lost);
  }

  static bool is_left(Outcome outcome) {
    return outcome == Outcome::lost || outcome == Outcome::passes;
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

  /// The rank of an item decides, then chance or, in racing mode, who came first.
  std::uint32_t new_key(const Item& item, std::size_t position) {
    std::uint32_t rank = 0;
    if constexpr (RankedOperator<Op>) rank = static_cast<std::uint8_t>(op_.priority(item));
    const auto place = static_cast<std::uint32_t>(position);
    const std::uint32_t tie = executor_.deterministic()
                                  ? mix_bits(place ^ (window_ * 0x9e3779b9U), tie_bits_)
                                  : atomic_count(ticket_);
    return static_cast<std::uint32_t>(first_key_) + ((rank << tie_bits_) | tie);
  }

  Outcome reserve(const Item& item, std::size_t position) {
    const std::uint32_t key = key_of_[position] = new_key(item, position);
    bool any = false;
    op_.footprint(item, [&](std::uint32_t resource) {
      atomic_min(reserved_[resource], key);
      any = true;
    });
    return any ? Outcome::lost : Outcome::gone;  // unless it turns out to hold all
  }

  void settle(const Item& item, std::size_t position, Counts& counts) {
    Outcome& outcome = outcome_of_[position];
    if (outcome == Outcome::lost && holds_all(item, key_of_[position])) outcome = Outcome::runs;
    counts.run += outcome == Outcome::runs;
    counts.lost += outcome == Outcome::lost;
    counts.left += is_left(outcome);
  }

  bool holds_all(const Item& item, std::uint32_t key) const {
    bool all = true;
    op_.footprint(item, [&](std::uint32_t resource) { all = all && reserved_[resource] == key; });
    return all;
  }

  Batches<Op, Check>& batches_;
  const Executor& executor_ = batches_.executor;
  Op& op_ = batches_.op;
  UnsetVector<std::uint32_t> reserved_;  // [resource], the lowest key that asked
  std::uint32_t share_ = everyone;       // who has a hash up to this asks

  // ---- The window being run ----
  std::uint32_t window_ = 0;
  std::uint64_t first_key_ = all_keys;  // all below are left for later windows
  unsigned tie_bits_ = 0;               // of a key, below the rank
  UnsetVector<std::uint32_t> key_of_;   // [position]
  UnsetVector<Outcome> outcome_of_;     // [position]
  UnsetVector<Counts> counts_of_;       // [block]
  UnsetVector<Item> winners_;
  std::uint32_t ticket_ = 0;  // racing mode: how many have come
};

}  // namespace ductile::runtime::detail
