/// @file
/// DeferredUpdate: writes to data that somebody else owns, kept until it is safe to carry them out.
/// While a loop runs, any thread defers updates, each for the owner of what it changes. After the
/// loop, commit() runs each owner's updates on exactly one thread, so that they need no locks.
/// Every thread writes to buffers of its own, one per group of owners ("bucket"); commit() shares
/// out the buckets. Owners with nearby numbers share a bucket, which keeps their data in cache.
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ductile/runtime/chunk_list.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/run_sort.hpp"

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
      : executor_(executor),
        options_(options),
        bucket_mask_(
            std::clamp(std::bit_ceil(8U * static_cast<unsigned>(executor.threads())), 64U, 1024U) -
            1),
        lanes_(executor) {}

  /// Keeps `update` for `owner`. `source` is who defers it, for instance the item being applied;
  /// under by_source one source defers from one thread only between two commits.
  /// Thread safety: any thread of a loop of the executor, or the caller outside of loops.
  /// Throws std::bad_alloc, or what copying an update throws; it is not kept then.
  void defer(std::uint32_t owner, std::uint64_t source, T&& update) {
    keep(owner, source, std::move(update));
  }
  void defer(std::uint32_t owner, std::uint64_t source,
             const T& update) requires std::copy_constructible<T> {
    keep(owner, source, update);
  }

  /// Calls f(owner, update) for every update kept, each owner's on one thread, and forgets them.
  /// f may move from an update, and must not defer to this object. An exception thrown by f reaches
  /// the caller; the updates that were not committed by then are dropped. Thread safety: one
  /// thread, no loop running.
  template <class F>
  void commit(F&& f) {
    const std::vector<std::uint32_t> buckets = touched_buckets();
    const auto commit_one = [&](std::size_t b) {
      const Rewind rewind{*this, buckets[b]};
      if (by_source()) {
        commit_sorted(buckets[b], f);
      } else {
        commit_unsorted(buckets[b], f);
      }
    };
    try {
      parallel_for(executor_, buckets.size(), commit_one,
                   {.grain = 1, .serial_below = size() < small ? buckets.size() + 1 : 0});
    } catch (...) {
      clear();
      throw;
    }
    forget_touched();
  }

  /// Updates waiting. Thread safety: one thread, no loop running.
  std::size_t size() const {
    std::size_t sum = 0;
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      for (const std::uint32_t number : lanes_[t].touched)
        visit_bucket(t, number, [&](const auto& bucket) { sum += bucket.size(); });
    return sum;
  }

  /// Drops all updates and keeps the memory. Thread safety: one thread, no loop running.
  void clear() {
    for (const std::uint32_t number : touched_buckets()) rewind_bucket(number);
    forget_touched();
  }

  /// Drops all updates and gives all buffers back. Thread safety: one thread, no loop running.
  void release() {
    clear();
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t] = Lane();
  }

 private:
  struct Plain {
    std::uint32_t owner;
    T update;
  };
  struct Sourced {
    std::uint64_t source;
    std::uint32_t owner;
    T update;
  };
  /// Buckets of one thread, of the kind that the order of commits needs; none before its first
  /// update.
  struct Lane {
    std::unique_ptr<ChunkList<Plain>[]> plain;
    std::unique_ptr<ChunkList<Sourced>[]> sourced;
    std::vector<std::uint32_t> touched;      // buckets with updates, in order of first use
    RunSort<std::uint64_t, Sourced*> order;  // scratch of commit_sorted
  };
  struct Rewind {
    ~Rewind() { self.rewind_bucket(number); }
    DeferredUpdate& self;
    std::uint32_t number;
  };

  static constexpr std::size_t small = 256;      // updates not worth waking a team for
  static constexpr unsigned neighbour_bits = 8;  // owners in a row that share a bucket

  bool by_source() const { return options_.order == CommitOrder::by_source; }

  /// As few steps as can be: this is what loops call for every update.
  template <class Value>
  void keep(std::uint32_t owner, std::uint64_t source, Value&& update) {
    Lane& lane = lanes_.mine();
    if (!lane.plain && !lane.sourced) [[unlikely]]
      make_buckets(lane);
    const std::uint32_t number = (owner >> neighbour_bits) & bucket_mask_;
    if (lane.plain) {
      append(lane, number, lane.plain[number], owner, std::forward<Value>(update));
    } else {
      append(lane, number, lane.sourced[number], source, owner, std::forward<Value>(update));
    }
  }

  template <class Entry, class... Arguments>
  static void append(Lane& lane, std::uint32_t number, ChunkList<Entry>& bucket,
                     Arguments&&... arguments) {
    if (bucket.full()) [[unlikely]]
      make_room(lane, number, bucket);
    bucket.append(std::forward<Arguments>(arguments)...);
  }

  /// Only the lanes of threads that defer something get any.
  [[gnu::noinline]] void make_buckets(Lane& lane) const {
    const std::size_t count = std::size_t{bucket_mask_} + 1;
    lane.touched.reserve(count);
    if (by_source()) {
      lane.sourced = std::make_unique<ChunkList<Sourced>[]>(count);
    } else {
      lane.plain = std::make_unique<ChunkList<Plain>[]>(count);
    }
  }

  /// Not inlined, so as to keep the caller's loop tight.
  template <class Entry>
  [[gnu::noinline]] static void make_room(Lane& lane, std::uint32_t number,
                                          ChunkList<Entry>& bucket) {
    const bool first = bucket.empty();
    bucket.grow();
    if (first) lane.touched.push_back(number);  // cannot throw: make_buckets() reserved
  }

  template <class Visit>
  void visit_bucket(std::size_t thread, std::uint32_t number, Visit&& visit) {
    Lane& lane = lanes_[thread];
    if (lane.sourced) visit(lane.sourced[number]);
    if (lane.plain) visit(lane.plain[number]);
  }
  template <class Visit>
  void visit_bucket(std::size_t thread, std::uint32_t number, Visit&& visit) const {
    const_cast<DeferredUpdate*>(this)->visit_bucket(thread, number, visit);
  }

  template <class F>
  void commit_unsorted(std::uint32_t number, F& f) {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      if (lanes_[t].plain)
        lanes_[t].plain[number].for_each([&](Plain& entry) { f(entry.owner, entry.update); });
  }

  template <class Visit>
  void for_each_sourced(std::uint32_t number, Visit&& visit) {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      if (lanes_[t].sourced) lanes_[t].sourced[number].for_each(visit);
  }

  /// As it is where threads went through their parts of a loop in order and took none from others.
  bool is_sorted(std::uint32_t number) {
    std::uint64_t last = 0;
    bool sorted = true;
    for_each_sourced(number, [&](const Sourced& entry) {
      sorted = sorted && last <= entry.source;
      last = entry.source;
    });
    return sorted;
  }

  /// Sorting a bucket by source alone is enough: it puts each of its owners' updates in order.
  template <class F>
  void commit_sorted(std::uint32_t number, F& f) {
    const auto commit = [&](Sourced& entry) { f(entry.owner, entry.update); };
    if (is_sorted(number)) return for_each_sourced(number, commit);
    auto& order = lanes_.mine().order;
    order.clear();
    for_each_sourced(number, [&](Sourced& entry) { order.append(entry.source, &entry); });
    for (const auto& keyed : order.sorted()) commit(*keyed.value);
  }

  std::vector<std::uint32_t> touched_buckets() const {
    std::vector<std::uint32_t> all;
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      all.insert(all.end(), lanes_[t].touched.begin(), lanes_[t].touched.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  void rewind_bucket(std::uint32_t number) {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      visit_bucket(t, number, [](auto& bucket) { bucket.rewind(); });
  }

  void forget_touched() {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].touched.clear();
  }

  Executor executor_;
  DeferredUpdateOptions options_;
  std::uint32_t bucket_mask_;  // their number, a power of two, less one
  PerThread<Lane> lanes_;
};

}  // namespace ductile::runtime
