/// @file
/// Deferrer: one thread's access to a DeferredUpdate, with minimal cost per update. A thread has a
/// buffer for each group of owners ("bucket"); a deferrer knows where the next update of each goes.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <utility>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/detail/buckets.hpp"

namespace ductile::runtime {

/// The order in which an owner's updates are committed.
enum class CommitOrder {
  any,      ///< the fastest order
  by_loop,  ///< the order in which a single thread would have deferred them
};

namespace detail {
template <class T, CommitOrder Order>
class DeferLane;

// An update as stored, with the data that its commit order needs.
template <class T, CommitOrder Order>
struct KeptUpdate {
  std::uint32_t owner;
  T update;
};
template <class T>
struct KeptUpdate<T, CommitOrder::by_loop> {
  std::uint64_t source;  // position in the loop
  std::uint32_t owner;
  T update;
};
}  // namespace detail

/// Access from DeferredUpdate::mine(); may be copied. Thread safety: the thread that asked for it,
/// while it runs the range of iterations for which it asked.
template <class T, CommitOrder Order>
class Deferrer {
 public:
  /// Stores `update` for `owner`. If it throws std::bad_alloc, or what copying or moving an update
  /// throws, the update is not stored.
  template <class U = T>
  requires std::constructible_from<T, U>
  void defer(std::uint32_t owner, U&& update) const {
    const std::size_t bucket = bucket_bits_.of(owner);
    void* next = rooms_.next[another(bucket)];
    if (next == rooms_.ends[another(bucket)]) [[unlikely]]
      next = lane_->make_room(static_cast<std::uint32_t>(bucket));
    // The hardware prefetcher does not follow many alternating lists.
    const auto ahead = reinterpret_cast<std::uintptr_t>(next) + write_ahead;
    __builtin_prefetch(reinterpret_cast<const void*>(ahead), 1);
    using Kept = detail::KeptUpdate<T, Order>;
    if constexpr (Order == CommitOrder::by_loop) {
      next = ::new (next) Kept{source_, owner, std::forward<U>(update)} + 1;
    } else {
      next = ::new (next) Kept{owner, std::forward<U>(update)} + 1;
    }
    rooms_.next[another(bucket)] = next;
  }

 private:
  friend detail::DeferLane<T, Order>;

  static constexpr std::size_t write_ahead = 512;  // bytes

  Deferrer() = default;

  /// The same number, hidden from the compiler, which would otherwise spend an instruction to
  /// compute an address once for all accesses; addressing modes do it for free.
  static std::size_t another(std::size_t bucket) {
    asm("" : "+r"(bucket));
    return bucket;
  }

  detail::Rooms rooms_{};  // of the buckets
  detail::DeferLane<T, Order>* lane_ = nullptr;
  detail::BitField bucket_bits_;  // maps an owner to its bucket
  std::uint64_t source_ = 0;
};

namespace detail {

/// The updates of one thread. A thread makes its lists when it first needs them, in nearby memory:
/// with short loops most threads never do.
template <class T, CommitOrder Order>
class DeferLane {
 public:
  using Lists = Buckets<KeptUpdate<T, Order>>;

  /// `is_touched` has a flag for each bucket, a power of two of them, set if the lane may have
  /// updates; 2^neighbour_bits consecutive owners, at least two, share a bucket.
  void set_up(std::span<std::uint8_t> is_touched, unsigned neighbour_bits) {
    is_touched_ = is_touched;
    deferrer_.bucket_bits_ = {neighbour_bits,
                              static_cast<unsigned>(std::countr_zero(is_touched.size()))};
    deferrer_.lane_ = this;
  }

  /// A deferrer for updates from one source. Throws std::bad_alloc.
  Deferrer<T, Order> deferrer(std::uint64_t source) {
    if (lists_ == nullptr) provide();
    Deferrer<T, Order> made = deferrer_;
    made.source_ = source;
    return made;
  }

  /// Makes room for an update in a full bucket; returns where. Not inlined, to keep the caller's
  /// loop tight. Throws std::bad_alloc.
  [[gnu::noinline]] void* make_room(std::uint32_t number) {
    lists_->grow(number);
    atomic_mark(is_touched_[number]);
    return deferrer_.rooms_.next[number];
  }

  /// Null if the thread has not needed any yet.
  Lists* lists() const { return lists_.get(); }

 private:
  [[gnu::noinline]] void provide() {
    auto lists = std::make_unique<Lists>();
    lists->provide(is_touched_.size());
    deferrer_.rooms_ = lists->rooms();
    lists_ = std::move(lists);
  }

  Deferrer<T, Order> deferrer_;
  std::span<std::uint8_t> is_touched_;  // [bucket], shared by all lanes
  std::unique_ptr<Lists> lists_;
};

}  // namespace detail
}  // namespace ductile::runtime
