/// @file
/// Deferrer: one thread's way into a DeferredUpdate, in as few steps as can be, because loops take
/// them for every update. A thread has a buffer for each group of owners ("bucket"); a deferrer
/// knows where to look up where the next update of each goes.
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

/// In which order an owner's updates are committed.
enum class CommitOrder {
  any,      ///< whatever is fastest
  by_loop,  ///< the order in which one thread alone would have deferred them
};

namespace detail {
template <class T, CommitOrder Order>
class DeferLane;

// What is kept of an update, as the order of commits needs it.
template <class T, CommitOrder Order>
struct KeptUpdate {
  std::uint32_t owner;
  T update;
};
template <class T>
struct KeptUpdate<T, CommitOrder::by_loop> {
  std::uint64_t source;  // where in a loop it comes from
  std::uint32_t owner;
  T update;
};
}  // namespace detail

/// From DeferredUpdate::mine(). Copies are as good. Thread safety: the thread that asked for it,
/// while it runs the range of iterations for which it asked.
template <class T, CommitOrder Order>
class Deferrer {
 public:
  /// Keeps `update` for `owner`. Throws std::bad_alloc, or what copying or moving an update throws;
  /// it is not kept then.
  template <class U = T>
  requires std::constructible_from<T, U>
  void defer(std::uint32_t owner, U&& update) const {
    const std::size_t bucket = bucket_bits_.of(owner);
    void* next = rooms_.next[another(bucket)];
    if (next == rooms_.ends[another(bucket)]) [[unlikely]]
      next = lane_->make_room(static_cast<std::uint32_t>(bucket));
    // Where many lists grow in turn, the processor does not see by itself what comes next in each.
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

  /// The same number, which compilers do not see. Otherwise they compute an address from it once,
  /// by an instruction, for all accesses; each of them can do that by itself, as part of what it
  /// does.
  static std::size_t another(std::size_t bucket) {
    asm("" : "+r"(bucket));
    return bucket;
  }

  detail::Rooms rooms_{};  // of the buckets
  detail::DeferLane<T, Order>* lane_ = nullptr;
  detail::BitField bucket_bits_;  // of an owner, its bucket's number
  std::uint64_t source_ = 0;
};

namespace detail {

/// What one thread deferred. The lists are made by the thread when it asks for them first, near
/// itself: most threads never do where loops are short.
template <class T, CommitOrder Order>
class DeferLane {
 public:
  using Lists = Buckets<KeptUpdate<T, Order>>;

  /// `is_touched` has a flag for each bucket, as many as a power of two, which is set where the
  /// lane may have updates; 2^neighbour_bits owners in a row, at least two, share a bucket.
  void set_up(std::span<std::uint8_t> is_touched, unsigned neighbour_bits) {
    is_touched_ = is_touched;
    deferrer_.bucket_bits_ = {neighbour_bits,
                              static_cast<unsigned>(std::countr_zero(is_touched.size()))};
    deferrer_.lane_ = this;
  }

  /// For updates from one place. Throws std::bad_alloc.
  Deferrer<T, Order> deferrer(std::uint64_t source) {
    if (lists_ == nullptr) provide();
    Deferrer<T, Order> made = deferrer_;
    made.source_ = source;
    return made;
  }

  /// For one more update in a full bucket; returns where. Not inlined, so as to keep the caller's
  /// loop tight. Throws std::bad_alloc.
  [[gnu::noinline]] void* make_room(std::uint32_t number) {
    lists_->grow(number);
    atomic_mark(is_touched_[number]);
    return deferrer_.rooms_.next[number];
  }

  /// Null if the thread has not asked for any yet.
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
