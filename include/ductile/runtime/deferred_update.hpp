/// @file
/// DeferredUpdate: writes to data that somebody else owns, kept until it is safe to carry them out.
/// While a loop runs, any thread defers updates, each for the owner of what it changes. After the
/// loop, commit() runs each owner's updates on exactly one thread, so that they need no locks.
/// Every thread writes to buffers of its own, one per group of owners ("bucket"); commit() shares
/// out the buckets. Owners with nearby numbers share a bucket, which keeps their data in cache.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/deferrer.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// In which order an owner's updates are committed.
enum class CommitOrder {
  any,        ///< whatever is fastest
  by_source,  ///< by (source, order in which that source deferred): the same at any thread count
};

struct DeferredUpdateOptions {
  CommitOrder order = CommitOrder::any;
};

/// Updates stay where defer() put them, of whatever size and alignment T is. Between construction
/// and destruction an object serves one loop or commit() at a time, on the executor it was made
/// with.
template <class T>
requires std::move_constructible<T>
class DeferredUpdate {
 public:
  explicit DeferredUpdate(const Executor& executor, DeferredUpdateOptions options = {})
      : executor_(executor), by_source_(options.order == CommitOrder::by_source), lanes_(executor) {
    const auto threads = static_cast<unsigned>(executor.threads());
    is_touched_.resize(std::clamp(std::bit_ceil(8U * threads), 16U, 1024U));
    // As many owners in a row as have their data in cache; fewer where a window of a mesh, whose
    // owners are near by, should be in enough buckets for all threads.
    const unsigned neighbour_bits = threads == 1 ? 16 : threads < 8 ? 8 : 7;
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      lanes_[t].set_up(is_touched_, neighbour_bits, by_source_);
  }

  /// Keeps `update` for `owner`. `source` is who defers it, for instance the item being applied;
  /// under by_source one source defers from one thread only between two commits.
  /// Thread safety: any thread of a loop of the executor, or the caller outside of loops.
  /// Throws std::bad_alloc, or what copying an update throws; it is not kept then.
  void defer(std::uint32_t owner, std::uint64_t source, T&& update) {
    lanes_.mine().deferrer().defer(owner, source, std::move(update));
  }
  void defer(std::uint32_t owner, std::uint64_t source,
             const T& update) requires std::copy_constructible<T> {
    lanes_.mine().deferrer().defer(owner, source, update);
  }

  /// Defers for the calling thread, without looking up each time which one that is: for who defers
  /// many updates in a row. Valid until release(). Throws std::bad_alloc. Thread safety: as
  /// defer().
  Deferrer<T> deferrer() { return lanes_.mine().ready_deferrer(); }

  /// Calls f(owner, update) for every update kept, each owner's on one thread, and forgets them.
  /// Returns how many there were. f may move from an update, and append to a Worklist of the same
  /// executor, as commit() is a loop; it must not defer to this object. An exception thrown by f
  /// reaches the caller; the updates that were not committed by then are dropped.
  /// Thread safety: one thread, no loop running.
  template <class F>
  std::size_t commit(F&& f) {
    find_touched();
    if (touched_.empty()) return 0;
    std::atomic<std::size_t> updates = 0;
    const auto commit_one = [&](std::size_t b) {
      const std::uint32_t number = touched_[b];
      updates.fetch_add(by_source_ ? commit_by_source(number, f) : commit_in_any_order(number, f),
                        std::memory_order_relaxed);
      clear(number);
    };
    const ClearedAtEnd cleared{*this};  // if f throws
    parallel_for(executor_, touched_.size(), commit_one,
                 {.grain = 1, .serial_below = are_few() ? touched_.size() + 1 : 0});
    return updates;
  }

  /// Updates waiting. Thread safety: one thread, no loop running.
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
  }

  /// Drops all updates and gives all buffers back. Thread safety: one thread, no loop running.
  void release() {
    clear();
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].release();
    std::vector<std::uint32_t>().swap(touched_);
  }

 private:
  using Lane = detail::DeferLane<T>;
  using Lists = typename Lane::Lists;
  using Plain = detail::PlainUpdate<T>;
  using Sourced = detail::SourcedUpdate<T>;
  struct ClearedAtEnd {
    DeferredUpdate& self;
    ~ClearedAtEnd() { self.clear(); }
  };

  /// The functions for one bucket of all lanes return how many updates it has. Thread safety: one
  /// thread at a time for each bucket.
  template <class F>
  std::size_t commit_in_any_order(std::uint32_t number, F& f) {
    std::size_t updates = 0;
    const auto commit_chunk = [&](Plain* begin, Plain* end) {
      for (Plain* entry = begin; entry != end; ++entry) f(entry->owner, entry->update);
      updates += static_cast<std::size_t>(end - begin);
    };
    for_each_lists([&](const Lists& lists) { lists.plain.for_each_chunk(number, commit_chunk); });
    return updates;
  }

  /// Ordering a bucket by source alone is enough: it puts each of its owners' updates in order.
  template <class F>
  std::size_t commit_by_source(std::uint32_t number, F& f) {
    detail::SourceOrder<Sourced>& order = lanes_.mine().order();
    order.clear();
    std::size_t updates = 0;
    const auto add_chunk = [&](Sourced* begin, Sourced* end) {
      order.add(begin, end);
      updates += static_cast<std::size_t>(end - begin);
    };
    for_each_lists([&](const Lists& lists) { lists.sourced.for_each_chunk(number, add_chunk); });
    order.for_each([&](Sourced& entry) { f(entry.owner, entry.update); });
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

  /// Of the threads that have deferred something.
  void for_each_lists(auto&& visit) const {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      if (auto* const lists = lanes_[t].lists()) visit(*lists);
  }

  /// Sets touched_ to the buckets with updates of any thread.
  void find_touched() {
    touched_.clear();
    for (std::uint32_t b = 0; b < is_touched_.size(); ++b)
      if (is_touched_[b] != 0) touched_.push_back(b);
  }

  /// Whether it is not worth waking a team for what was touched.
  bool are_few() const {
    constexpr std::size_t few_updates = 256, quickly_counted = 512;  // buckets of single threads
    if (touched_.size() * lanes_.size() > quickly_counted) return false;
    std::size_t updates = 0;
    for (const std::uint32_t number : touched_) updates += size(number);
    return updates < few_updates;
  }

  Executor executor_;
  bool by_source_;
  PerThread<Lane> lanes_;
  std::vector<std::uint8_t> is_touched_;  // [bucket], whether any thread may have updates there
  std::vector<std::uint32_t> touched_;    // scratch of commit(): such buckets
};

}  // namespace ductile::runtime
