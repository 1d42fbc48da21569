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
  using Room = detail::Room;

  static constexpr std::size_t write_ahead = 512;  // bytes

  // What depends on the order comes last and is short: compilers then make a loop for each order.
  template <class Value>
  void keep(std::uint32_t owner, std::uint64_t source, Value&& update) const {
    const std::uint32_t mask = offset_mask_;  // make_room() does not change the order in it
    std::size_t offset = (owner >> offset_shift_) & mask;
    void* next = room_at(another(offset)).next;
    if (next == room_at(another(offset)).end) [[unlikely]] {
      lane_->make_room(owner);
      offset = (owner >> offset_shift_) & offset_mask_;
      next = room_at(offset).next;
    }
    // Where many lists grow in turn, the processor does not see by itself what comes next in each.
    const auto ahead = reinterpret_cast<std::uintptr_t>(next) + write_ahead;
    __builtin_prefetch(reinterpret_cast<const void*>(ahead), 1);
    if ((mask & by_source) != 0) {
      next = append<detail::SourcedUpdate<T>>(next, source, owner, std::forward<Value>(update));
    } else {
      next = append<detail::PlainUpdate<T>>(next, owner, std::forward<Value>(update));
    }
    room_at(another(offset)).next = next;
  }

  Room& room_at(std::size_t offset) const {
    return *reinterpret_cast<Room*>(reinterpret_cast<std::byte*>(rooms_) + offset);
  }
  /// The same, which compilers do not see. Else they add it to rooms_ once, by an instruction, for
  /// all accesses; each of them can do that by itself, as part of what it does.
  static std::size_t another(std::size_t offset) {
    asm("" : "+r"(offset));
    return offset;
  }

  template <class Entry, class... Arguments>
  static Entry* append(void* next, Arguments&&... arguments) {
    return ::new (next) Entry{std::forward<Arguments>(arguments)...} + 1;
  }

  static constexpr std::uint32_t by_source = 1U << 31U;  // beyond all offsets
  static inline Room no_room_;                           // full

  Room* rooms_ = &no_room_;  // of the buckets
  detail::DeferLane<T>* lane_ = nullptr;
  // A bucket's room in rooms_, in bytes: bits of the owner, shifted. And by_source.
  std::uint32_t offset_mask_ = 0, offset_shift_ = 0;
};

namespace detail {

/// What one thread deferred: plain or sourced updates, not both.
template <class T>
class DeferLane {
 public:
  Buckets<PlainUpdate<T>> plain;
  Buckets<SourcedUpdate<T>> sourced;
  SourceOrder<SourcedUpdate<T>> order;  // scratch of commits

  /// `bucket_count` is a power of two; 2^neighbour_bits owners in a row, at least 32, share a
  /// bucket.
  void set_up(std::uint32_t bucket_count, unsigned neighbour_bits, bool by_source) {
    bucket_count_ = bucket_count;
    neighbour_bits_ = neighbour_bits;
    deferrer_.offset_shift_ = neighbour_bits - std::countr_zero(sizeof(Room));
    by_source_ = by_source;
    deferrer_.lane_ = this;
    set_offset_mask(0);
  }

  /// For one update: has no buckets before the first.
  const Deferrer<T>& deferrer() const { return deferrer_; }

  /// For many. Throws std::bad_alloc.
  const Deferrer<T>& ready_deferrer() {
    if (deferrer_.rooms_ == &Deferrer<T>::no_room_) provide();
    return deferrer_;
  }

  /// For one more update of this owner. Not inlined, so as to keep the caller's loop tight.
  /// Throws std::bad_alloc.
  [[gnu::noinline]] void make_room(std::uint32_t owner) {
    if (deferrer_.rooms_ == &Deferrer<T>::no_room_) provide();
    const std::uint32_t number = (owner >> neighbour_bits_) & (bucket_count_ - 1);
    if (by_source_) {
      sourced.grow(number);
    } else {
      plain.grow(number);
    }
  }

  std::size_t size() const { return plain.size() + sourced.size(); }

  /// Of the buckets that may have updates.
  std::span<const std::uint32_t> touched() const {
    return by_source_ ? sourced.touched() : plain.touched();
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
    deferrer_.rooms_ = &Deferrer<T>::no_room_;
    set_offset_mask(0);
  }

 private:
  void provide() {
    if (by_source_) {
      sourced.provide(bucket_count_);
      deferrer_.rooms_ = sourced.rooms();
    } else {
      plain.provide(bucket_count_);
      deferrer_.rooms_ = plain.rooms();
    }
    set_offset_mask((bucket_count_ - 1) * static_cast<std::uint32_t>(sizeof(Room)));
  }

  void set_offset_mask(std::uint32_t mask) {
    deferrer_.offset_mask_ = mask | (by_source_ ? Deferrer<T>::by_source : 0);
  }

  Deferrer<T> deferrer_;
  std::uint32_t bucket_count_ = 0;
  unsigned neighbour_bits_ = 0;
  bool by_source_ = false;
};

}  // namespace detail
}  // namespace ductile::runtime
