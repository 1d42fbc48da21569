/// @file
/// Worklist: a bag of items that many threads fill at once and one thread reads back later.
/// A thread appends to a private batch; publish() places the whole batch by one atomic
/// fetch-and-add on the common length, without a barrier. The common storage is a row of segments,
/// so it grows while others publish and nothing moves. collect() makes the items contiguous, and,
/// on request, sorts them and drops duplicates: then they do not depend on threads or timing.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/batch.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime {

enum class WorkOrder {
  arrival,  ///< as published, which depends on timing
  by_item,  ///< sorted by operator<
};

struct WorklistOptions {
  WorkOrder order = WorkOrder::by_item;
  bool unique = false;       ///< drop duplicates; the items are then sorted as well
  std::size_t batch = 1024;  ///< a private batch of this many items publishes itself
};

/// An object serves one loop of its executor at a time.
template <class T>
requires std::is_trivially_copyable_v<T>
class Worklist {
 public:
  explicit Worklist(const Executor& executor, WorklistOptions options = {})
      : executor_(executor), options_(options), batches_(executor) {
    options_.batch = std::max<std::size_t>(1, options_.batch);
  }
  ~Worklist() { release(); }
  Worklist(const Worklist&) = delete;
  Worklist& operator=(const Worklist&) = delete;

  /// Adds an item to the calling thread's batch.
  /// Thread safety: any thread of a loop of the executor, or the caller outside of loops.
  void append(const T& item) {
    detail::Batch<T>& batch = batches_.mine();
    if (batch.full()) [[unlikely]]
      make_room(batch);
    batch.append(item);
  }

  /// Places the calling thread's batch in the common list. Throws std::bad_alloc; the list can then
  /// only be cleared. Thread safety: as append().
  void publish() { place(batches_.mine()); }

  /// Publishes what all threads still hold and readies items(). Thread safety: one thread, after
  /// the loop. Throws std::bad_alloc.
  void collect() {
    for (std::size_t t = 0; t < batches_.size(); ++t) place(batches_[t]);
    if (broken_.load(std::memory_order_relaxed)) throw std::bad_alloc();
    size_ = length_.load(std::memory_order_relaxed);
    if (size_ > segment_end(0)) gather();
    const bool sorted = options_.unique || options_.order == WorkOrder::by_item;
    if (sorted) parallel_sort(executor_, mutable_items());
    if (options_.unique) {
      size_ = parallel_unique(executor_, mutable_items());
      length_.store(size_, std::memory_order_relaxed);
    }
  }

  /// The items as of the last collect(). Thread safety: any thread while nobody changes the list.
  std::span<const T> items() const { return {segments_[0].load(std::memory_order_relaxed), size_}; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Moves the collected items out and leaves the list empty. Thread safety: one thread.
  std::vector<T> take() {
    std::vector<T> all(items().begin(), items().end());
    clear();
    return all;
  }

  /// Forgets all items and keeps the memory. Thread safety: one thread.
  void clear() {
    for (std::size_t t = 0; t < batches_.size(); ++t) batches_[t].clear();
    length_.store(0, std::memory_order_relaxed);
    broken_.store(false, std::memory_order_relaxed);
    size_ = 0;
  }

  /// Forgets all items and gives the memory back. Thread safety: one thread.
  void release() {
    clear();
    for (std::size_t t = 0; t < batches_.size(); ++t) batches_[t].release();
    for (unsigned k = 0; k < segment_count; ++k) free_segment(k);
    first_bits_ = initial_bits;
  }

 private:
  // Segment 0 holds the first 2^first_bits_ items, segment k > 0 as many as all before it.
  static constexpr unsigned initial_bits = 10;
  static constexpr unsigned segment_count = 48;

  std::size_t segment_begin(unsigned k) const {
    return k == 0 ? 0 : std::size_t{1} << (first_bits_ + k - 1);
  }
  std::size_t segment_end(unsigned k) const { return std::size_t{1} << (first_bits_ + k); }
  std::size_t segment_capacity(unsigned k) const { return segment_end(k) - segment_begin(k); }
  unsigned segment_of(std::size_t position) const {
    return static_cast<unsigned>(std::bit_width(position >> first_bits_));
  }
  std::span<T> mutable_items() { return {segments_[0].load(std::memory_order_relaxed), size_}; }

  [[gnu::noinline]] void make_room(detail::Batch<T>& batch) {
    if (batch.reserved()) {
      place(batch);
    } else {
      batch.reserve(options_.batch);
    }
  }

  void place(detail::Batch<T>& batch) {
    const std::span<const T> items = batch.items();
    if (items.empty()) return;
    // Relaxed: it hands out places only; the items are read after the barrier that ends the loop.
    std::size_t to = length_.fetch_add(items.size(), std::memory_order_relaxed);
    try {
      for (std::size_t from = 0; from < items.size();) {
        const unsigned k = segment_of(to);
        const std::size_t n = std::min(items.size() - from, segment_end(k) - to);
        std::copy_n(items.data() + from, n, provide_segment(k) + (to - segment_begin(k)));
        from += n, to += n;
      }
    } catch (...) {
      broken_.store(true, std::memory_order_relaxed);  // read after the loop's barrier
      throw;
    }
    batch.clear();
  }

  T* provide_segment(unsigned k) {
    // Acquire pairs with the release below: the allocator's writes to the memory come first.
    T* segment = segments_[k].load(std::memory_order_acquire);
    if (segment != nullptr) return segment;
    T* const fresh = std::allocator<T>().allocate(segment_capacity(k));
    if (segments_[k].compare_exchange_strong(segment, fresh, std::memory_order_acq_rel))
      return fresh;
    std::allocator<T>().deallocate(fresh, segment_capacity(k));
    return segment;
  }

  void free_segment(unsigned k) {
    if (T* const segment = segments_[k].exchange(nullptr, std::memory_order_relaxed))
      std::allocator<T>().deallocate(segment, segment_capacity(k));
  }

  /// Makes segment 0 long enough for all items, now and in the rounds to come.
  void gather() {
    const auto bits = static_cast<unsigned>(std::bit_width(size_ - 1));
    T* const whole = std::allocator<T>().allocate(std::size_t{1} << bits);
    for (unsigned k = 0; k < segment_count && segment_begin(k) < size_; ++k) {
      const T* const segment = segments_[k].load(std::memory_order_relaxed);
      const std::size_t n = std::min(size_, segment_end(k)) - segment_begin(k);
      T* const to = whole + segment_begin(k);
      parallel_for_ranges(executor_, n,
                          [=](std::size_t begin, std::size_t end) {
                            std::copy_n(segment + begin, end - begin, to + begin);
                          },
                          {.grain = 16384, .serial_below = 65536});
    }
    for (unsigned k = 0; k < segment_count; ++k) free_segment(k);
    first_bits_ = bits;
    segments_[0].store(whole, std::memory_order_relaxed);
  }

  Executor executor_;
  WorklistOptions options_;
  unsigned first_bits_ = initial_bits;
  std::size_t size_ = 0;  // items collected
  PerThread<detail::Batch<T>> batches_;
  std::array<std::atomic<T*>, segment_count> segments_{};
  alignas(128) std::atomic<std::size_t> length_{0};  // places handed out
  alignas(128) std::atomic<bool> broken_{false};     // a place was handed out and not filled
};

}  // namespace ductile::runtime
