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
#include <utility>
#include <vector>

#include "ductile/runtime/deferrer.hpp"
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
    const std::uint32_t buckets = std::clamp(std::bit_ceil(8U * threads), 16U, 1024U);
    // As many owners in a row as have their data in cache; fewer where a window of a mesh, whose
    // owners are near by, should be in enough buckets for all threads.
    const unsigned neighbour_bits = threads == 1 ? 16 : threads < 8 ? 8 : 7;
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      lanes_[t].set_up(buckets, neighbour_bits, by_source_);
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
  /// Returns how many there were. f may move from an update, and must not defer to this object. An
  /// exception thrown by f reaches the caller; the updates that were not committed by then are
  /// dropped. Thread safety: one thread, no loop running.
  template <class F>
  std::size_t commit(F&& f) {
    const std::size_t updates = size();
    if (updates == 0) return 0;
    find_touched();
    const auto commit_one = [&](std::size_t b) {
      if (by_source_) {
        commit_by_source(touched_[b], f);
      } else {
        commit_in_any_order(touched_[b], f);
      }
      empty_bucket(touched_[b]);
    };
    const ClearedAtEnd cleared{*this};
    parallel_for(executor_, touched_.size(), commit_one,
                 {.grain = 1, .serial_below = updates < small ? touched_.size() + 1 : 0});
    return updates;
  }

  /// Updates waiting. Thread safety: one thread, no loop running.
  std::size_t size() const {
    std::size_t sum = 0;
    for (std::size_t t = 0; t < lanes_.size(); ++t) sum += lanes_[t].size();
    return sum;
  }

  /// Drops all updates and keeps the memory. Thread safety: one thread, no loop running.
  void clear() {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].clear();
  }

  /// Drops all updates and gives all buffers back. Thread safety: one thread, no loop running.
  void release() {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].release();
    std::vector<std::uint32_t>().swap(touched_);
  }

 private:
  using Lane = detail::DeferLane<T>;
  using Plain = detail::PlainUpdate<T>;
  using Sourced = detail::SourcedUpdate<T>;
  struct ClearedAtEnd {
    DeferredUpdate& self;
    ~ClearedAtEnd() { self.clear(); }
  };

  static constexpr std::size_t small = 256;  // updates not worth waking a team for

  template <class F>
  void commit_in_any_order(std::uint32_t number, F& f) {
    const auto commit_chunk = [&](Plain* begin, Plain* end) {
      for (Plain* entry = begin; entry != end; ++entry) f(entry->owner, entry->update);
    };
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      lanes_[t].plain.for_each_chunk(number, commit_chunk);
  }

  /// Ordering a bucket by source alone is enough: it puts each of its owners' updates in order.
  template <class F>
  void commit_by_source(std::uint32_t number, F& f) {
    detail::SourceOrder<Sourced>& order = lanes_.mine().order;
    order.clear();
    const auto add_chunk = [&](Sourced* begin, Sourced* end) { order.add(begin, end); };
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      lanes_[t].sourced.for_each_chunk(number, add_chunk);
    order.for_each([&](Sourced& entry) { f(entry.owner, entry.update); });
  }

  /// Sets touched_ to the buckets with updates of any thread, each once.
  void find_touched() {
    touched_.clear();
    std::size_t contributors = 0;
    for (std::size_t t = 0; t < lanes_.size(); ++t) {
      const auto numbers = lanes_[t].touched();
      touched_.insert(touched_.end(), numbers.begin(), numbers.end());
      contributors += !numbers.empty();
    }
    if (contributors > 1) detail::sort_and_make_unique(touched_);
  }

  void empty_bucket(std::uint32_t number) {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].clear(number);
  }

  Executor executor_;
  bool by_source_;
  PerThread<Lane> lanes_;
  std::vector<std::uint32_t> touched_;  // scratch of commit(): buckets with updates
};

}  // namespace ductile::runtime
