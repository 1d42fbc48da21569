/// @file
/// What a Worklist is made of: a Batch of each thread, and Segments, into which whole batches go.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// An array of a fixed capacity that one thread fills and somebody else then empties. Its memory
/// comes with the first element and stays until release().
template <class T>
class Batch {
 public:
  Batch() = default;
  ~Batch() { release(); }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  bool full() const { return next_ == end_; }  ///< or without memory yet
  std::span<T> items() { return {begin_, next_}; }

  /// Precondition: !full(). Changes nothing if moving or copying the item throws.
  template <class Item>
  void append(Item&& item) {
    std::construct_at(next_, std::forward<Item>(item)), ++next_;
  }

  /// Precondition: no memory yet. Throws std::bad_alloc.
  void reserve(std::size_t capacity) {
    begin_ = next_ = std::allocator<T>().allocate(capacity);
    end_ = begin_ + capacity;
  }
  bool reserved() const { return begin_ != nullptr; }

  void clear() {
    if constexpr (!std::is_trivially_destructible_v<T>) std::destroy(begin_, next_);
    next_ = begin_;
  }
  void release() {
    clear();
    if (reserved()) std::allocator<T>().deallocate(begin_, static_cast<std::size_t>(end_ - begin_));
    begin_ = next_ = end_ = nullptr;
  }

 private:
  T* next_ = nullptr;
  T* end_ = nullptr;
  T* begin_ = nullptr;
};

/// Uninitialised places for items, known by position, that many threads may ask for at once. Each
/// segment is as long as all before it, so that there is never a need to move items to make room;
/// gather() puts them into one segment when nobody adds any. Does not know which places hold an
/// item: who puts them there destroys them.
template <class T>
class Segments {
 public:
  Segments() = default;
  ~Segments() { release(); }
  Segments(const Segments&) = delete;
  Segments& operator=(const Segments&) = delete;

  /// The first segment, null if there is none yet. Thread safety: while nobody gathers.
  T* first() const { return segments_[0].load(std::memory_order_relaxed); }

  /// Precondition: the place was provided. Thread safety: any thread that provided it, others after
  /// the loop.
  T* at(std::size_t position) const {
    const unsigned k = number_of(position);
    return segments_[k].load(std::memory_order_relaxed) + (position - begin_of(k));
  }

  /// Where the contiguous places from this one on end.
  std::size_t end_after(std::size_t position) const { return end_of(number_of(position)); }

  /// Sees to it that there is memory for places [begin, end), which are not none.
  /// Throws std::bad_alloc. Thread safety: any thread.
  void provide(std::size_t begin, std::size_t end) {
    for (unsigned k = number_of(begin); k <= number_of(end - 1); ++k) provide_segment(k);
  }

  /// Moves the items at the first `count` places into one segment, if they are in more; it holds
  /// that many in the rounds to come as well. Throws std::bad_alloc. Thread safety: one thread.
  void gather(const Executor& executor, std::size_t count) {
    if (count <= end_of(0)) return;
    const auto bits = static_cast<unsigned>(std::bit_width(count - 1));
    T* const whole = std::allocator<T>().allocate(std::size_t{1} << bits);
    for (unsigned k = 0; k < most && begin_of(k) < count; ++k) {
      T* const from = segments_[k].load(std::memory_order_relaxed);
      T* const to = whole + begin_of(k);
      const auto relocate = [=](std::size_t begin, std::size_t end) {
        std::uninitialized_move(from + begin, from + end, to + begin);
        std::destroy(from + begin, from + end);
      };
      parallel_for_ranges(executor, std::min(count, end_of(k)) - begin_of(k), relocate,
                          {.grain = 16384, .serial_below = 65536});
    }
    release();
    first_bits_ = bits;
    segments_[0].store(whole, std::memory_order_relaxed);
  }

  /// Gives all memory back. Thread safety: one thread.
  void release() {
    for (unsigned k = 0; k < most; ++k)
      if (T* const segment = segments_[k].exchange(nullptr, std::memory_order_relaxed))
        std::allocator<T>().deallocate(segment, capacity_of(k));
    first_bits_ = initial_bits;
  }

 private:
  // Segment 0 has 2^first_bits_ places: at first 1024, or fewer if they are more than 16 KiB.
  static constexpr auto initial_bits =
      static_cast<unsigned>(std::bit_width(std::clamp<std::size_t>(16384 / sizeof(T), 1, 1024))) -
      1;
  static constexpr unsigned most = 64 - initial_bits;

  std::size_t begin_of(unsigned k) const {
    return k == 0 ? 0 : std::size_t{1} << (first_bits_ + k - 1);
  }
  std::size_t end_of(unsigned k) const { return std::size_t{1} << (first_bits_ + k); }
  std::size_t capacity_of(unsigned k) const { return end_of(k) - begin_of(k); }
  unsigned number_of(std::size_t position) const {
    return static_cast<unsigned>(std::bit_width(position >> first_bits_));
  }

  void provide_segment(unsigned k) {
    // Acquire pairs with the release below: the allocator's writes to the memory come first.
    T* segment = segments_[k].load(std::memory_order_acquire);
    if (segment != nullptr) return;
    T* const fresh = std::allocator<T>().allocate(capacity_of(k));
    if (!segments_[k].compare_exchange_strong(segment, fresh, std::memory_order_acq_rel))
      std::allocator<T>().deallocate(fresh, capacity_of(k));
  }

  unsigned first_bits_ = initial_bits;
  std::array<std::atomic<T*>, most> segments_{};
};

}  // namespace ductile::runtime::detail
