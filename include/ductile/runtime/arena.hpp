/// @file
/// Arena: memory for many short arrays that any thread may ask for and that never move. An array
/// is known by a 32-bit index, so structures that point into the arena stay small.
/// Segments have a fixed power-of-two length; an array lies in one segment, or, if it is longer,
/// in consecutive segments backed by one block. Single arrays are not given back: the owner keeps
/// its own free lists, or copies what lives into another arena and clears this one.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Memory in segments that never move; see the top of this file.
template <class T, unsigned SegmentBits = 18>
requires std::is_trivially_copyable_v<T> &&(SegmentBits >= 12) && (SegmentBits <= 28) class Arena {
 public:
  static constexpr std::uint64_t segment_size = std::uint64_t{1} << SegmentBits;
  static constexpr std::uint64_t capacity = std::uint64_t{1} << 32U;

  Arena() : table_(std::make_unique<std::atomic<T*>[]>(slot_count)) {}
  ~Arena() { release(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// The index of n consecutive elements, uninitialised. Throws std::length_error when the 32-bit
  /// index space is used up, std::bad_alloc when memory is. Thread safety: any thread.
  std::uint32_t allocate(std::uint32_t n) {
    if (n > segment_size) return allocate_long(n);
    for (;;) {
      // Relaxed: the cursor hands out numbers only; memory is published through the table.
      const std::uint64_t begin = cursor_.fetch_add(n, std::memory_order_relaxed);
      if (begin + n > capacity) refuse();
      const std::uint64_t slot = begin >> SegmentBits;
      // An array that would straddle two segments is given up, its place stays unused.
      if (n != 0 && (begin + n - 1) >> SegmentBits != slot) continue;
      if (slot < slot_count) provide_segment(slot);
      return static_cast<std::uint32_t>(begin);
    }
  }

  /// The element at an index that allocate() returned, or within the n that follow it; the n are
  /// contiguous. Valid until clear(). Thread safety: any thread that knows the index.
  T* at(std::uint32_t index) {
    // Acquire pairs with the release in provide_segment() and allocate_long().
    return table_[index >> SegmentBits].load(std::memory_order_acquire) + (index & mask);
  }
  const T* at(std::uint32_t index) const { return const_cast<Arena*>(this)->at(index); }

  /// Forgets every array and keeps the segments for those to come. Thread safety: one thread.
  void clear() {
    for (const Block& block : blocks_) drop(block);
    blocks_.clear();
    cursor_.store(0, std::memory_order_relaxed);
  }

  /// Forgets every array and gives back all memory except the table. Thread safety: one thread.
  void release() {
    clear();
    for (std::uint64_t slot = 0; slot < slot_count; ++slot) free_segment(slot);
  }

  /// The same on all threads of an executor, because the system frees pages one by one and a single
  /// thread would hold up the others. Thread safety: one caller.
  void release(const Executor& executor) {
    clear();
    std::size_t end = slot_count;  // end of the used slots; otherwise they would all fall into one
                                   // thread's range
    while (end > 0 && table_[end - 1].load(std::memory_order_relaxed) == nullptr) --end;
    parallel_for(executor, end, [&](std::size_t slot) { free_segment(slot); }, {.grain = 1});
  }

 private:
  struct Block {
    T* begin;
    std::uint64_t first_slot, slots;
  };
  static constexpr std::uint64_t mask = segment_size - 1;
  static constexpr std::uint64_t slot_count = capacity >> SegmentBits;

  static T* new_elements(std::uint64_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{alignment}));
  }
  static void delete_elements(T* elements) {
    ::operator delete (elements, std::align_val_t{alignment});
  }
  static constexpr std::size_t alignment = alignof(T) < 128 ? 128 : alignof(T);

  [[noreturn]] static void refuse() { throw std::length_error("Arena: more than 2^32 elements"); }

  void provide_segment(std::uint64_t slot) {
    if (table_[slot].load(std::memory_order_acquire) != nullptr) return;
    T* const fresh = new_elements(segment_size);
    T* expected = nullptr;
    // Release pairs with the acquire in at(): a thread that sees the segment sees its contents.
    if (!table_[slot].compare_exchange_strong(expected, fresh, std::memory_order_acq_rel))
      delete_elements(fresh);
  }

  std::uint32_t allocate_long(std::uint32_t n) {
    const std::uint64_t slots = (n + mask) >> SegmentBits;
    const std::uint64_t step = (slots + 1) << SegmentBits;
    const std::uint64_t start = cursor_.fetch_add(step, std::memory_order_relaxed);
    const std::uint64_t first_slot = (start + mask) >> SegmentBits;
    if (first_slot + slots > slot_count) refuse();
    const std::lock_guard lock(blocks_mutex_);
    blocks_.push_back({nullptr, first_slot, 0});  // recorded before the allocation, because
                                                  // push_back may throw
    T* const block = new_elements(slots << SegmentBits);
    blocks_.back() = {block, first_slot, slots};
    for (std::uint64_t s = 0; s < slots; ++s) {
      free_segment(first_slot + s);  // a segment that clear() kept; nobody has an index into it
      table_[first_slot + s].store(block + (s << SegmentBits), std::memory_order_release);
    }
    return static_cast<std::uint32_t>(first_slot << SegmentBits);
  }

  void free_segment(std::uint64_t slot) {
    delete_elements(table_[slot].exchange(nullptr, std::memory_order_relaxed));
  }

  void drop(const Block& block) {
    for (std::uint64_t s = 0; s < block.slots; ++s)
      table_[block.first_slot + s].store(nullptr, std::memory_order_relaxed);
    delete_elements(block.begin);
  }

  std::unique_ptr<std::atomic<T*>[]> table_;  // [slot], the segment or a part of a block
  alignas(128) std::atomic<std::uint64_t> cursor_{0};
  alignas(128) std::mutex blocks_mutex_;
  std::vector<Block> blocks_;  // arrays longer than a segment
};

}  // namespace ductile::runtime
