/// @file
/// Worklist: a bag of items that many threads fill at once and one thread reads back later.
/// A thread appends to a private batch; publish() places the whole batch by one atomic
/// fetch-and-add on the common length, without a barrier. The common storage is a row of segments,
/// so it grows while others publish and nothing moves. collect() makes the items contiguous and
/// sorts them, so that they do not depend on threads or timing, unless they are to be left in the
/// order of their arrival; on request it drops duplicates.
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/segments.hpp"
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
  std::size_t batch = 1024;  ///< a private batch of this many items publishes itself; it is never
                             ///< more than 64 KiB of them
};

/// Moved from the batch to the common list, and so on, where nothing may fail.
template <class T>
concept WorkItem = std::movable<T> && std::is_nothrow_move_constructible_v<T>;

/// Items are moved from the batch to the common list, as it grows, and where they are sorted, so
/// moving one must not throw; they need not be copyable, nor have operator< if they are not to be
/// sorted. An object serves one loop of its executor at a time.
template <WorkItem T>
class Worklist {
 public:
  /// Throws std::invalid_argument if items are to be sorted that have no operator<.
  explicit Worklist(const Executor& executor, WorklistOptions options = {});
  ~Worklist() { release(); }
  Worklist(const Worklist&) = delete;
  Worklist& operator=(const Worklist&) = delete;

  /// Adds an item to the calling thread's batch. Throws std::bad_alloc, or what copying the item
  /// throws. Thread safety: any thread of a loop of the executor, or the caller outside of loops.
  void append(T&& item) { add(std::move(item)); }
  void append(const T& item) requires std::copy_constructible<T> { add(item); }

  /// Places the calling thread's batch in the common list. Throws std::bad_alloc; the list can then
  /// only be cleared. Thread safety: as append().
  void publish() { place(lanes_.mine()); }

  /// Publishes what all threads still hold and readies items(). Thread safety: one thread, after
  /// the loop. Throws std::bad_alloc, as publish() does.
  void collect();

  /// The items as of the last collect(). Thread safety: any thread while nobody changes the list.
  std::span<const T> items() const { return {places_.first(), size_}; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Moves the collected items out and leaves the list empty. Thread safety: one thread.
  UnsetVector<T> take();

  /// Forgets all items and keeps the memory. Thread safety: one thread.
  void clear();

  /// Forgets all items and gives the memory back. Thread safety: one thread.
  void release();

 private:
  struct Lane {
    detail::Batch<T> batch;
    std::size_t missing_begin = 0, missing_end = 0;  // places it was given and had no memory for
  };

  static constexpr bool ordered = requires(const T& a) {
    { a < a } -> std::convertible_to<bool>;
  };
  /// As many as fit into 64 KiB, at least one.
  static constexpr std::size_t longest_batch = std::max<std::size_t>(1, 65536 / sizeof(T));

  bool sorts() const { return options_.unique || options_.order == WorkOrder::by_item; }

  std::span<T> mutable_items() { return {places_.first(), size_}; }

  template <class Item>
  void add(Item&& item) {
    Lane& lane = lanes_.mine();
    if (lane.batch.full()) [[unlikely]]
      make_room(lane);
    lane.batch.append(std::forward<Item>(item));
  }

  [[gnu::noinline]] void make_room(Lane& lane);

  void place(Lane& lane);

  bool broken() const { return broken_.load(std::memory_order_relaxed); }

  bool is_missing(std::size_t position) const;

  void destroy_placed();

  /// Keeps the first `count` collected items.
  void drop_after(std::size_t count);

  Executor executor_;
  WorklistOptions options_;
  std::size_t size_ = 0;  // items collected
  PerThread<Lane> lanes_;
  detail::Segments<T> places_;
  alignas(128) std::atomic<std::size_t> length_{0};  // places handed out
  alignas(128) std::atomic<bool> broken_{false};     // some were not filled
};

// ---- What is not called for every item ----

template <WorkItem T>
Worklist<T>::Worklist(const Executor& executor, WorklistOptions options)
    : executor_(executor), options_(options), lanes_(executor) {
  if (!ordered && sorts())
    throw std::invalid_argument("Worklist: items without operator< can only be in arrival order");
  options_.batch = std::clamp<std::size_t>(options_.batch, 1, longest_batch);
}

template <WorkItem T>
void Worklist<T>::collect() {
  for (std::size_t t = 0; t < lanes_.size(); ++t) place(lanes_[t]);
  if (broken()) throw std::bad_alloc();
  const std::size_t all = length_.load(std::memory_order_relaxed);
  places_.gather(executor_, all);
  size_ = all;
  if constexpr (ordered) {
    if (sorts()) parallel_sort(executor_, mutable_items());
    if (options_.unique) drop_after(parallel_unique(executor_, mutable_items()));
  }
}

template <WorkItem T>
UnsetVector<T> Worklist<T>::take() {
  const std::span<T> all = mutable_items();
  UnsetVector<T> taken;
  if constexpr (std::is_trivially_copyable_v<T>) {
    taken = make_unset_vector<T>(executor_, all.size());
    parallel_for(
        executor_, all.size(), [&](std::size_t i) { taken[i] = all[i]; }, few_nanoseconds);
  } else {
    taken.assign(std::make_move_iterator(all.begin()), std::make_move_iterator(all.end()));
  }
  clear();
  return taken;
}

template <WorkItem T>
void Worklist<T>::clear() {
  destroy_placed();
  for (std::size_t t = 0; t < lanes_.size(); ++t) {
    lanes_[t].batch.clear();
    lanes_[t].missing_begin = lanes_[t].missing_end = 0;
  }
  length_.store(0, std::memory_order_relaxed);
  broken_.store(false, std::memory_order_relaxed);
  size_ = 0;
}

template <WorkItem T>
void Worklist<T>::release() {
  clear();
  for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].batch.release();
  places_.release();
}

template <WorkItem T>
void Worklist<T>::make_room(Lane& lane) {
  if (lane.batch.reserved()) {
    place(lane);
  } else {
    lane.batch.reserve(options_.batch);
  }
}

template <WorkItem T>
void Worklist<T>::place(Lane& lane) {
  const std::span<T> items = lane.batch.items();
  if (items.empty()) return;
  if (broken()) throw std::bad_alloc();  // so that no thread misses memory twice
  // Relaxed: it hands out places only; the items are read after the barrier that ends the loop.
  const std::size_t begin = length_.fetch_add(items.size(), std::memory_order_relaxed);
  const std::size_t end = begin + items.size();
  try {
    places_.provide(begin, end);
  } catch (...) {
    lane.missing_begin = begin, lane.missing_end = end;
    broken_.store(true, std::memory_order_relaxed);  // read after the loop's barrier
    throw;
  }
  for (std::size_t to = begin; to < end;) {
    const std::size_t n = std::min(end, places_.end_after(to)) - to;
    std::uninitialized_move_n(items.data() + (to - begin), n, places_.at(to));
    to += n;
  }
  lane.batch.clear();
}

template <WorkItem T>
bool Worklist<T>::is_missing(std::size_t position) const {
  for (std::size_t t = 0; t < lanes_.size(); ++t)
    if (lanes_[t].missing_begin <= position && position < lanes_[t].missing_end) return true;
  return false;
}

template <WorkItem T>
void Worklist<T>::destroy_placed() {
  if constexpr (std::is_trivially_destructible_v<T>) return;
  const bool some_missing = broken();
  const auto destroy = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!some_missing || !is_missing(i)) std::destroy_at(places_.at(i));
  };
  parallel_for_ranges(executor_, length_.load(std::memory_order_relaxed), destroy,
                      {.grain = 4096, .serial_below = 16384});
}

template <WorkItem T>
void Worklist<T>::drop_after(std::size_t count) {
  if constexpr (!std::is_trivially_destructible_v<T>) {
    const std::span<T> rest = mutable_items().subspan(count);
    std::destroy(rest.begin(), rest.end());
  }
  size_ = count;
  length_.store(count, std::memory_order_relaxed);
}

// Of items that are numbers: compiled once.
extern template class Worklist<std::uint32_t>;

}  // namespace ductile::runtime
