/// @file
/// Worklist: a bag of items that threads fill in loops and one thread reads afterwards, in the
/// order of a serial loop, or sorted and without repetition. Each thread appends to its own array;
/// collect() sorts the stretches of items by their iterations and copies each to its place.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/appender.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime {

/// An object serves one loop of its executor at a time.
template <WorkItem T>
class Worklist {
 public:
  explicit Worklist(const Executor& executor) : executor_(executor), lanes_(executor) {}

  /// The calling thread's access. parallel_for() gets it by with(); otherwise call this once per
  /// range of iterations, or once per item, which is slower. Throws std::bad_alloc,
  /// std::invalid_argument in a loop of an executor with another number of threads, and
  /// std::logic_error if the thread already has one. Thread safety: any thread of a loop of the
  /// executor, or the caller outside of loops.
  Appender<T> mine() {
    detail::expect_loop_of(executor_, "a worklist");
    detail::WorkLane<T>& lane = lanes_.mine();
    if (lane.lent) throw std::logic_error("a worklist: the thread has an appender already");
    lane.note_place();
    return Appender<T>(lane);
  }

  /// Moves appended items behind the collected ones, in the order of iterations, and of loops
  /// started by the same thread. In a nested loop the outer loop's order counts. If it throws
  /// std::bad_alloc, nothing changes. Thread safety: one thread, after the loop.
  void collect();

  /// collect(), then sorts all items by operator< and keeps each once.
  void collect_unique() requires requires(const T& a) {
    { a < a } -> std::convertible_to<bool>;
  };

  /// The items as of the last collect(). Thread safety: any thread while nobody changes the list.
  std::span<const T> items() const { return collected_; }
  std::size_t size() const { return collected_.size(); }
  bool empty() const { return collected_.empty(); }

  /// Moves the collected items out and leaves the list empty. Thread safety: one thread.
  UnsetVector<T> take() { return std::exchange(collected_, {}); }

  /// Removes all items and keeps the memory. Thread safety: one thread.
  void clear() {
    clear_lanes();
    collected_.clear();
  }

 private:
  /// The items of one stretch and their destination.
  struct Run {
    detail::Stretch stretch;
    T* from;
    std::size_t count, to;
  };

  void take_all_of(detail::WorkLane<T>& lane) {
    collected_.swap(lane.items);
    if constexpr (detail::WorkLane<T>::has_rest) {
      collected_.resize(lane.used);
      lane.items.resize(lane.items.capacity());
    }
  }

  std::vector<Run> runs_in_order();
  void copy(const std::vector<Run>& runs, T* to);

  void clear_lanes() {
    for (std::size_t t = 0; t < lanes_.size(); ++t) lanes_[t].clear();
  }

  Executor executor_;
  PerThread<detail::WorkLane<T>> lanes_;
  UnsetVector<T> collected_;
};

template <WorkItem T>
auto Worklist<T>::runs_in_order() -> std::vector<Run> {
  std::vector<Run> runs;
  for (std::size_t t = 0; t < lanes_.size(); ++t) {
    std::size_t end = lanes_[t].used;
    for (auto s = lanes_[t].stretches.rbegin(); s != lanes_[t].stretches.rend(); ++s) {
      runs.push_back({*s, lanes_[t].items.data() + s->first, end - s->first, 0});
      end = s->first;
    }
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return std::pair(a.stretch.loop, a.stretch.begin) < std::pair(b.stretch.loop, b.stretch.begin);
  });
  std::size_t to = 0;
  for (Run& run : runs) run.to = std::exchange(to, to + run.count);
  return runs;
}

/// Each thread copies an equal part, regardless of where runs begin and end.
template <WorkItem T>
void Worklist<T>::copy(const std::vector<Run>& runs, T* to) {
  const auto copy_range = [&](std::size_t begin, std::size_t end) {
    auto run = std::partition_point(runs.begin(), runs.end(),
                                    [&](const Run& r) { return r.to + r.count <= begin; });
    for (; begin < end; ++run) {
      const std::size_t next = std::min(end, run->to + run->count);
      std::copy(run->from + (begin - run->to), run->from + (next - run->to), to + begin);
      begin = next;
    }
  };
  parallel_for_ranges(executor_, runs.back().to + runs.back().count, copy_range,
                      {.grain = 4096, .serial_below = 16384});
}

template <WorkItem T>
void Worklist<T>::collect() {
  const std::vector<Run> runs = runs_in_order();
  if (runs.empty()) return;
  const std::size_t before = collected_.size(), all = before + runs.back().to + runs.back().count;
  if (runs.size() == 1 && before == 0) {
    for (std::size_t t = 0; t < lanes_.size(); ++t)
      if (!lanes_[t].stretches.empty()) take_all_of(lanes_[t]);
  } else {
    collected_.reserve(all);
    detail::touch_pages(executor_, collected_.data(), all * sizeof(T));
    if constexpr (std::is_trivially_copyable_v<T>) {
      collected_.resize(all);
      copy(runs, collected_.data() + before);
    } else {
      for (const Run& run : runs)
        for (std::size_t i = 0; i < run.count; ++i) collected_.push_back(std::move(run.from[i]));
    }
  }
  clear_lanes();
}

template <WorkItem T>
void Worklist<T>::collect_unique() requires requires(const T& a) {
  { a < a } -> std::convertible_to<bool>;
}
{
  collect();
  parallel_sort(executor_, std::span(collected_));
  const std::size_t kept = parallel_unique(executor_, std::span(collected_));
  collected_.erase(collected_.begin() + static_cast<std::ptrdiff_t>(kept), collected_.end());
}

/// Collects in a loop: calls find(i, append) for i in [0, n); append(item) adds an item to the
/// result, where items of a lower i come first. Below `serial_below` indices, the caller works
/// alone. Thread safety: one caller; runs on the executor.
template <WorkItem Item, class Find>
UnsetVector<Item> parallel_collect(const Executor& executor, std::size_t n, Find&& find,
                                   std::size_t serial_below = 0) {
  Worklist<Item> found(executor);
  parallel_for(executor, n, with(found),
               [&](std::size_t i, Appender<Item>& mine) {
                 find(i, [&mine](Item item) { mine.append(std::move(item)); });
               },
               {.serial_below = serial_below});
  found.collect();
  return found.take();
}

}  // namespace ductile::runtime
