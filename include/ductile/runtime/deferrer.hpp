/// @file
/// Deferrer: one thread's way into a DeferredUpdate, in as few steps as can be, for loops take them
/// for every update. A thread has a buffer for each group of owners ("bucket"); a deferrer knows
/// where to look up where the next update of each goes.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <utility>

#include "ductile/runtime/detail/bit_field.hpp"
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

/// Valid until its DeferredUpdate releases its memory. Copies are as good.
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

/// What one thread deferred: plain or sourced updates, not both.
template <class T>
class DeferLane {
 public:
  Buckets<PlainUpdate<T>> plain;
  Buckets<SourcedUpdate<T>> sourced;
  SourceOrder<SourcedUpdate<T>> order;  // scratch of commits

  /// `bucket_count` is a power of two; 2^neighbour_bits owners in a row, at least two, share
  /// a bucket.
  void set_up(std::uint32_t bucket_count, unsigned neighbour_bits, bool by_source) {
    bucket_count_ = bucket_count;
    bucket_bits_ = {neighbour_bits, static_cast<unsigned>(std::countr_zero(bucket_count))};
    deferrer_.by_source_ = by_source;
    deferrer_.lane_ = this;
  }

  /// For one update: has no buckets before the first.
  const Deferrer<T>& deferrer() const { return deferrer_; }

  /// For many. Throws std::bad_alloc.
  const Deferrer<T>& ready_deferrer() {
    if (!has_buckets()) provide();
    return deferrer_;
  }

  /// For one more update of this owner. Not inlined, so as to keep the caller's loop tight.
  /// Throws std::bad_alloc.
  [[gnu::noinline]] void make_room(std::uint32_t owner) {
    if (!has_buckets()) provide();
    const auto number = static_cast<std::uint32_t>(bucket_bits_.of(owner));
    if (deferrer_.by_source_) {
      sourced.grow(number);
    } else {
      plain.grow(number);
    }
  }

  std::size_t size() const { return plain.size() + sourced.size(); }

  /// Of the buckets that may have updates.
  std::span<const std::uint32_t> touched() const {
    return deferrer_.by_source_ ? sourced.touched() : plain.touched();
  }

  /// Drops a bucket's updates. Thread safety: one thread at a time for each bucket.
  void clear(std::uint32_t number) {
    plain.clear(number);
    sourced.clear(number);
  }

  /// Drops all updates and keeps the memory.
  void clear() {
    plain.clear();
    sourced.clear();
  }

  /// Drops all updates and gives the memory back.
  void release() {
    plain.release();
    sourced.release();
    order = {};
    deferrer_.rooms_ = Deferrer<T>().rooms_;
    deferrer_.bucket_bits_ = {};
  }

 private:
  bool has_buckets() const { return deferrer_.rooms_.next != &Deferrer<T>::nowhere_; }

  void provide() {
    if (deferrer_.by_source_) {
      sourced.provide(bucket_count_);
      deferrer_.rooms_ = sourced.rooms();
    } else {
      plain.provide(bucket_count_);
      deferrer_.rooms_ = plain.rooms();
    }
    deferrer_.bucket_bits_ = bucket_bits_;
  }

  Deferrer<T> deferrer_;
  BitField bucket_bits_;  // the deferrer's when there are buckets
  std::uint32_t bucket_count_ = 0;
};

}  // namespace detail
}  // namespace ductile::runtime
