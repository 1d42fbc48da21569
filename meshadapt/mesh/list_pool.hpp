/// @file
/// ListPool: one short sorted list per index (the elements around each vertex), all in one arena.
/// A sorted list does not depend on the order of its changes, so commits need no order either.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "ductile/runtime/arena.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/growing_array.hpp"

namespace ductile::meshadapt {

/// Many short lists in one arena; see the top of this file.
template <class T>
class ListPool {
 public:
  std::size_t size() const { return slot_of_.size(); }

  /// Replaces all lists by n empty ones. Throws std::bad_alloc. Thread safety: one caller; runs on
  /// the executor.
  void reset(const runtime::Executor& executor, std::size_t n) {
    slot_of_.resize_for_overwrite(n);
    const auto empty = [](Slot* begin, Slot* end) { std::fill(begin, end, Slot{}); };
    runtime::write_first(executor, slot_of_.data(), n, empty,
                         {.grain = 4096, .serial_below = 16384});
    arena_->clear();
  }

  /// The same, but the lists are invalid until reserve_all(). Thread safety: one thread.
  void reset_for_overwrite(std::size_t n, runtime::FreshMemory& fresh) {
    slot_of_.resize_for_overwrite(n, fresh);
    arena_->clear();
  }

  /// Removes all lists and gives their memory back. Thread safety: one caller; runs on the
  /// executor.
  void release(const runtime::Executor& executor) {
    slot_of_.release(executor);
    arena_->release(executor);
  }

  /// Appends empty lists until there are n, and adds their pages to `fresh`. Thread safety: one
  /// thread.
  void grow(std::size_t n, runtime::FreshMemory& fresh) { slot_of_.resize(n, fresh); }

  [[gnu::always_inline]] std::span<const T> of(std::uint32_t index) const {
    const Slot& slot = slot_of_[index];
    return slot.count == 0 ? std::span<const T>{}
                           : std::span<const T>{arena_->at(slot.begin), slot.count};
  }

  bool empty(std::uint32_t index) const { return slot_of_[index].count == 0; }

  /// Starts to bring a list into the cache: its first and last cache lines.
  void prefetch(std::uint32_t index) const {
    const Slot& slot = slot_of_[index];
    if (slot.count == 0) return;
    const T* const begin = arena_->at(slot.begin);
    __builtin_prefetch(begin);
    __builtin_prefetch(begin + slot.count - 1);
  }

  /// Locks a list for threads that change it concurrently; their order does not matter because the
  /// list is sorted. Thread safety: any thread, if all threads hold the list while they change or
  /// read it.
  [[nodiscard]] runtime::NumberWithLock::Held hold(std::uint32_t index) {
    return slot_of_[index].capacity.hold();
  }

  // The following members change one list. Thread safety: the owner of that list, or the thread
  // that holds it.

  void insert(std::uint32_t index, const T& value) {
    Slot& slot = slot_of_[index];
    if (slot.count == slot.capacity.get()) reserve(index, slot.count + slot.count / 2 + 4);
    T* const begin = arena_->at(slot.begin);
    T* at = begin + slot.count;
    for (; at != begin && value < at[-1]; --at) *at = at[-1];
    *at = value;
    ++slot.count;
  }

  /// The value must be in the list.
  void erase(std::uint32_t index, const T& value) {
    Slot& slot = slot_of_[index];
    T* const begin = arena_->at(slot.begin);
    T* const end = begin + slot.count;
    T* const at = std::find(begin, end, value);
    assert(at != end);
    std::copy(at + 1, end, at);
    --slot.count;
  }

  /// Erases some values and inserts others, both ascending; the erased ones must be in the list.
  void replace(std::uint32_t index, std::span<const T> gone, std::span<const T> come) {
    Slot& slot = slot_of_[index];
    const auto count = static_cast<std::uint32_t>(slot.count - gone.size() + come.size());
    if (count > slot.capacity.get()) reserve(index, count + count / 2);
    T* const begin = arena_->at(slot.begin);
    T* from = begin;  // end of the values that stay
    auto next = gone.begin();
    for (const T *at = begin, *end = begin + slot.count; at != end; ++at)
      if (next != gone.end() && *at == *next)
        ++next;
      else
        *from++ = *at;
    assert(next == gone.end());
    // Goes backwards, so that nothing is overwritten before it has been moved.
    T* to = begin + count;
    for (std::size_t i = come.size(); i-- > 0; *--to = come[i])
      while (from != begin && come[i] < from[-1]) *--to = *--from;
    slot.count = count;
  }

  void clear(std::uint32_t index) { slot_of_[index].count = 0; }

  void reserve(std::uint32_t index, std::uint32_t capacity) {
    Slot& slot = slot_of_[index];
    if (capacity <= slot.capacity.get()) return;
    const std::uint32_t begin = arena_->allocate(capacity);
    if (slot.count != 0) std::copy_n(arena_->at(slot.begin), slot.count, arena_->at(begin));
    slot.begin = begin;
    slot.capacity.set(capacity);
  }

  /// Makes the lists [begin, end) empty with room for capacity_of(index) each, side by side: one
  /// request to the arena instead of many for which threads would compete.
  void reserve_all(std::uint32_t begin, std::uint32_t end, auto&& capacity_of) {
    std::uint32_t total = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const std::uint32_t capacity = capacity_of(i);
      slot_of_[i].capacity.set(capacity);
      total += capacity;
    }
    std::uint32_t place = arena_->allocate(total);
    for (std::uint32_t i = begin; i < end; ++i) {
      slot_of_[i].count = 0;
      slot_of_[i].begin = std::exchange(place, place + slot_of_[i].capacity.get());
    }
  }

  /// Raw access for the parallel construction: count and storage of one list.
  std::uint32_t& count_of(std::uint32_t index) { return slot_of_[index].count; }
  T* data(std::uint32_t index) { return arena_->at(slot_of_[index].begin); }

 private:
  struct Slot {
    std::uint32_t begin = 0, count = 0;
    runtime::NumberWithLock capacity;
  };
  runtime::GrowingArray<Slot> slot_of_;
  std::unique_ptr<runtime::Arena<T>> arena_ = std::make_unique<runtime::Arena<T>>();
};

}  // namespace ductile::meshadapt
