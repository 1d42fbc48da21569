/// @file
/// DeferredUpdate: writes to data that somebody else owns, kept until it is safe to carry them out.
/// While a loop runs, any thread defers updates, each for the owner of the data it changes. After
/// the loop, commit() runs each owner's updates on exactly one thread, so that they need no locks.
/// Every thread writes to its own buffers, one per group of owners ("bucket"); commit() distributes
/// the buckets. Owners with nearby numbers share a bucket, which keeps their data in cache.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/detail/deferrer.hpp"
#include "ductile/runtime/detail/source_order.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Updates stay where defer() put them, whatever size and alignment T has. An object serves one
/// loop or commit() at a time, on the executor it was made with.
template <class T, CommitOrder Order = CommitOrder::any>
requires std::move_constructible<T>
class DeferredUpdate {
 public:
  explicit DeferredUpdate(const Executor& executor) : executor_(executor), lanes_(executor) {
    const auto threads = static_cast<unsigned>(executor.threads());
    is_touched_.resize(std::clamp(std::bit_ceil(8U * threads), 16U, 1024U));
    // Owners per bucket: as many as have their data in cache; fewer with many threads, so that a
    // window of a mesh, whose owners are close, still spreads over enough buckets.
    const unsigned neighbour_bits = threads == 1 ? 16 : threads < 8 ? 8 : 7;
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      lanes_[t].lane.set_up(is_touched_, neighbour_bits);
  }

  /// The calling thread's access. parallel_for() gets it by with(); otherwise call this once per
  /// range of iterations, or once per update, which is slower. Throws std::bad_alloc, and
  /// std::invalid_argument in a loop of an executor with another number of threads. Thread safety:
  /// any thread of a loop of the executor, or the caller outside of loops.
  Deferrer<T, Order> mine() {
    detail::expect_loop_of(executor_, "a deferred update");
    return lanes_.mine().lane.deferrer(Order == CommitOrder::by_loop ? source() : 0);
  }

  /// Calls f(owner, update) for every pending update, each owner's on one thread, and removes them.
  /// Returns their number. f may move from an update, and append to a Worklist of the same
  /// executor, because commit() is a loop; the order of that list depends on the number of threads
  /// unless collect_unique() collects it. f must not defer to this object. If f throws, the
  /// exception reaches the caller and the remaining updates are dropped. Thread safety: one thread,
  /// no loop running.
  template <class F>
  std::size_t commit(F&& f) {
    find_touched();
    if (touched_.empty()) return 0;
    std::atomic<std::size_t> updates = 0;
    const auto commit_one = [&](std::size_t b) {
      const std::uint32_t number = touched_[b];
      updates.fetch_add(commit_bucket(number, f), std::memory_order_relaxed);
      clear(number);
    };
    const ClearedAtEnd cleared{*this};  // if f throws
    parallel_for(executor_, touched_.size(), commit_one,
                 {.grain = 1, .serial_below = are_few() ? touched_.size() + 1 : 0});
    return updates;
  }

  /// Number of pending updates. Thread safety: one thread, no loop running.
  std::size_t size() const {
    std::size_t sum = 0;
    for (std::uint32_t b = 0; b < is_touched_.size(); ++b)
      if (is_touched_[b] != 0) sum += size(b);
    return sum;
  }

  /// Drops all updates and keeps the memory. Thread safety: one thread, no loop running.
  void clear() {
    for (std::uint32_t b = 0; b < is_touched_.size(); ++b)
      if (is_touched_[b] != 0) clear(b);
    first_loop_ = detail::loop_place.loop;
  }

 private:
  using Lists = typename detail::DeferLane<T, Order>::Lists;
  using Kept = detail::KeptUpdate<T, Order>;
  struct PerLane {
    detail::DeferLane<T, Order> lane;
    detail::SourceOrder<Kept> order;  // scratch of commits
  };
  struct ClearedAtEnd {
    DeferredUpdate& self;
    ~ClearedAtEnd() { self.clear(); }
  };

  /// The calling thread's position in its loop, as a number that grows with the order of loops and
  /// iterations.
  std::uint64_t source() const {
    constexpr unsigned bits = 40;  // for the iteration
    const detail::LoopPlace& place = detail::loop_place;
    return (place.loop - first_loop_) << bits |
           std::min<std::uint64_t>(place.begin, (std::uint64_t{1} << bits) - 1);
  }

  /// Returns the bucket's number of updates. Ordering the bucket by source also orders each owner's
  /// updates. Thread safety: one thread at a time for each bucket.
  template <class F>
  std::size_t commit_bucket(std::uint32_t number, F& f) {
    std::size_t updates = 0;
    detail::SourceOrder<Kept>& order = lanes_.mine().order;
    if constexpr (Order == CommitOrder::by_loop) order.clear();
    const auto commit_chunk = [&](Kept* begin, Kept* end) {
      updates += static_cast<std::size_t>(end - begin);
      if constexpr (Order == CommitOrder::by_loop) {
        order.add(begin, end);
      } else {
        for (Kept* kept = begin; kept != end; ++kept) f(kept->owner, kept->update);
      }
    };
    for_each_lists([&](const Lists& lists) { lists.for_each_chunk(number, commit_chunk); });
    if constexpr (Order == CommitOrder::by_loop)
      order.for_each([&](Kept& kept) { f(kept.owner, kept.update); });
    return updates;
  }

  std::size_t size(std::uint32_t number) const {
    std::size_t sum = 0;
    for_each_lists([&](const Lists& lists) { sum += lists.size(number); });
    return sum;
  }

  void clear(std::uint32_t number) {
    for_each_lists([&](Lists& lists) { lists.clear(number); });
    is_touched_[number] = 0;
  }

  /// Visits the lists of the threads that have deferred something.
  void for_each_lists(auto&& visit) const {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      if (auto* const lists = lanes_[t].lane.lists()) visit(*lists);
  }

  /// Sets touched_ to the buckets in which any thread has updates.
  void find_touched() {
    touched_.clear();
    for (std::uint32_t b = 0; b < is_touched_.size(); ++b)
      if (is_touched_[b] != 0) touched_.push_back(b);
  }

  /// Are there too few updates to be worth waking a team?
  bool are_few() const {
    constexpr std::size_t few_updates = 256, quickly_counted = 512;  // buckets of single threads
    if (touched_.size() * lanes_.size() > quickly_counted) return false;
    std::size_t updates = 0;
    for (const std::uint32_t number : touched_) updates += size(number);
    return updates < few_updates;
  }

  Executor executor_;
  PerThread<PerLane> lanes_;
  std::uint64_t first_loop_ = detail::loop_place.loop;  // first loop with pending updates
  std::vector<std::uint8_t> is_touched_;  // [bucket], may any thread have updates there?
  std::vector<std::uint32_t> touched_;    // scratch of commit(): the touched buckets
};

}  // namespace ductile::runtime
