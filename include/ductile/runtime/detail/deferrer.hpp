/// @file
/// Deferrer: one thread's way into a DeferredUpdate, in as few steps as can be, for loops take them
/// for every update. A thread has a buffer for each group of owners ("bucket"); a deferrer knows
/// where to look up where the next update of each goes.
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
#include "ductile/runtime/detail/source_order.hpp"

namespace ductile::runtime {

namespace detail {
template <class T>
class DeferLane;

// What is kept of an update, as the order of commits needs it.
template <class T>
struct PlainUpdate {
  std::uint32_t owner;
  T update;
};
template <class T>
struct SourcedUpdate {
  std::uint64_t source;
  std::uint32_t owner;
  T update;
};
}  // namespace detail

/// Valid until its DeferredUpdate releases its memory. Copies are as good. One that is made without
/// a DeferredUpdate can only be assigned to.
/// Thread safety: the thread that asked for it, while it may defer at all.
template <class T>
class Deferrer {
 public:
  Deferrer() = default;

  /// As DeferredUpdate::defer().
  void defer(std::uint32_t owner, std::uint64_t source, T&& update) const {
    keep(owner, source, std::move(update));
  }
  void defer(std::uint32_t owner, std::uint64_t source,
             const T& update) const requires std::copy_constructible<T> {
    keep(owner, source, update);
  }

 private:
  friend detail::DeferLane<T>;

  static constexpr std::size_t write_ahead = 512;  // bytes

  // What depends on the order comes last and is short: compilers then make a loop for each order.
  template <class Value>
  void keep(std::uint32_t owner, std::uint64_t source, Value&& update) const {
    const bool by_source = by_source_;  // make_room() does not change it
    std::size_t bucket = bucket_bits_.of(owner);
    void* next = rooms_.next[another(bucket)];
    if (next == rooms_.ends[another(bucket)]) [[unlikely]] {
      lane_->make_room(owner);
      bucket = bucket_bits_.of(owner);
      next = rooms_.next[bucket];
    }
    // Where many lists grow in turn, the processor does not see by itself what comes next in each.
    const auto ahead = reinterpret_cast<std::uintptr_t>(next) + write_ahead;
    __builtin_prefetch(reinterpret_cast<const void*>(ahead), 1);
    if (by_source) {
      next = append<detail::SourcedUpdate<T>>(next, source, owner, std::forward<Value>(update));
    } else {
      next = append<detail::PlainUpdate<T>>(next, owner, std::forward<Value>(update));
    }
    rooms_.next[another(bucket)] = next;
  }

  /// The same number, which compilers do not see. Else they compute an address from it once, by an
  /// instruction, for all accesses; each of them can do that by itself, as part of what it does.
  static std::size_t another(std::size_t bucket) {
    asm("" : "+r"(bucket));
    return bucket;
  }

  template <class Entry, class... Arguments>
  static Entry* append(void* next, Arguments&&... arguments) {
    return ::new (next) Entry{std::forward<Arguments>(arguments)...} + 1;
  }

  static inline void* nowhere_ = nullptr;  // where a list is full

  detail::Rooms rooms_{&nowhere_, &nowhere_};  // of the buckets
  detail::DeferLane<T>* lane_ = nullptr;
  detail::BitField bucket_bits_;  // of an owner, its bucket's number
  bool by_source_ = false;
};

namespace detail {

/// What one thread deferred: plain or sourced updates, not both. The lists are made by the thread
/// when it has its first update, near itself: most threads never have one where batches are small.
template <class T>
class DeferLane {
 public:
  struct Lists {
    Buckets<PlainUpdate<T>> plain;
    Buckets<SourcedUpdate<T>> sourced;

    /// Of one bucket. Thread safety: one thread at a time for each bucket.
    std::size_t size(std::uint32_t number) const {
      return plain.size(number) + sourced.size(number);
    }
    void clear(std::uint32_t number) {
      plain.clear(number);
      sourced.clear(number);
    }
  };

  /// `is_touched` has a flag for each bucket, as many as a power of two, which is set where the
  /// lane may have updates; 2^neighbour_bits owners in a row, at least two, share a bucket.
  void set_up(std::span<std::uint8_t> is_touched, unsigned neighbour_bits, bool by_source) {
    is_touched_ = is_touched;
    bucket_bits_ = {neighbour_bits, static_cast<unsigned>(std::countr_zero(is_touched.size()))};
    deferrer_.by_source_ = by_source;
    deferrer_.lane_ = this;
  }

  /// For one update: has no buckets before the first.
  const Deferrer<T>& deferrer() const { return deferrer_; }

  /// For many. Throws std::bad_alloc.
  const Deferrer<T>& ready_deferrer() {
    if (lists_ == nullptr) provide();
    return deferrer_;
  }

  /// For one more update of this owner. Not inlined, so as to keep the caller's loop tight.
  /// Throws std::bad_alloc.
  [[gnu::noinline]] void make_room(std::uint32_t owner) {
    if (lists_ == nullptr) provide();
    const auto number = static_cast<std::uint32_t>(bucket_bits_.of(owner));
    if (deferrer_.by_source_) {
      lists_->sourced.grow(number);
    } else {
      lists_->plain.grow(number);
    }
    atomic_mark(is_touched_[number]);
  }

  /// Null if the thread has not deferred anything yet.
  Lists* lists() const { return lists_.get(); }

  /// Scratch of commits. Throws std::bad_alloc.
  SourceOrder<SourcedUpdate<T>>& order() {
    if (order_ == nullptr) order_ = std::make_unique<SourceOrder<SourcedUpdate<T>>>();
    return *order_;
  }

  /// Drops all updates and gives the memory back.
  void release() {
    lists_.reset();
    order_.reset();
    deferrer_.rooms_ = Deferrer<T>().rooms_;
    deferrer_.bucket_bits_ = {};
  }

 private:
  void provide() {
    auto lists = std::make_unique<Lists>();
    if (deferrer_.by_source_) {
      lists->sourced.provide(is_touched_.size());
      deferrer_.rooms_ = lists->sourced.rooms();
    } else {
      lists->plain.provide(is_touched_.size());
      deferrer_.rooms_ = lists->plain.rooms();
    }
    deferrer_.bucket_bits_ = bucket_bits_;
    lists_ = std::move(lists);
  }

  Deferrer<T> deferrer_;
  BitField bucket_bits_;                // the deferrer's when there are lists
  std::span<std::uint8_t> is_touched_;  // [bucket], shared by all lanes
  std::unique_ptr<Lists> lists_;
  std::unique_ptr<SourceOrder<SourcedUpdate<T>>> order_;
};

}  // namespace detail
}  // namespace ductile::runtime
