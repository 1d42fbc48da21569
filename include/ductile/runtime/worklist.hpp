/// @file
/// Worklist: a bag of items that the threads of loops fill and one thread reads back afterwards, in
/// the order in which one thread alone would have found them, or sorted and each once. A thread
/// appends to an array of its own and notes from which item on it went through which range of
/// iterations; collect() sorts the notes and copies each stretch of items to its place.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"

namespace ductile::runtime {

/// Moved where nothing may fail. Items need not be copyable.
template <class T>
concept WorkItem = std::movable<T> && std::is_nothrow_move_constructible_v<T>;

namespace detail {

/// Items from `first` on were appended in iterations [begin, end) of a loop, in order.
struct Stretch {
  std::uint64_t loop;
  std::size_t begin, end;  // iterations
  std::size_t first;       // item
};

template <class T>
struct WorkLane {
  UnsetVector<T> items;
  std::vector<Stretch> stretches;

  /// What is appended from now on comes from where the calling thread is. Throws std::bad_alloc.
  void note_place() {
    const LoopPlace& place = loop_place;
    if (!stretches.empty()) {
      Stretch& last = stretches.back();
      const bool same_loop = last.loop == place.loop;
      if (same_loop && last.begin <= place.begin && place.end <= last.end) return;
      if (same_loop && last.end == place.begin) {  // where the last range ended
        last.end = place.end;
        return;
      }
      if (last.first == items.size()) stretches.pop_back();
    }
    stretches.push_back({place.loop, place.begin, place.end, items.size()});
  }
};

}  // namespace detail

/// One thread's way into a Worklist, from Worklist::mine(). Thread safety: that thread, while it
/// runs the range of iterations for which it asked.
template <WorkItem T>
class Appender {
 public:
  explicit Appender(detail::WorkLane<T>& lane) : items_(&lane.items) {}

  /// Throws std::bad_alloc, or what copying the item throws; it is not appended then.
  template <class U = T>
  requires std::constructible_from<T, U>
  void append(U&& item) const { items_->emplace_back(std::forward<U>(item)); }

 private:
  UnsetVector<T>* items_;
};

/// An object serves one loop of its executor at a time.
template <WorkItem T>
class Worklist {
 public:
  explicit Worklist(const Executor& executor) : executor_(executor), lanes_(executor) {}

  /// The calling thread's way in. parallel_for() asks for it by with(); otherwise ask once for a
  /// range of iterations, or for an item, which takes longer. Throws std::bad_alloc, and
  /// std::invalid_argument in a loop of an executor with another number of threads.
  /// Thread safety: any thread of a loop of the executor, or the caller outside of loops.
  Appender<T> mine() {
    detail::expect_loop_of(executor_, "a worklist");
    lanes_.mine().note_place();
    return Appender<T>(lanes_.mine());
  }

  /// Puts what was appended behind what was collected, in the order of iterations, those of one
  /// loop before those of the next that the same thread starts. In a loop inside another one that
  /// is the order of the outer loop. Throws std::bad_alloc and changes nothing then.
  /// Thread safety: one thread, after the loop.
  void collect();

  /// collect(), and sorts all of it by operator< and keeps each item once.
  void collect_unique() requires requires(const T& a) {
    { a < a } -> std::convertible_to<bool>;
  };

  /// The items as of the last collect(). Thread safety: any thread while nobody changes the list.
  std::span<const T> items() const { return collected_; }
  std::size_t size() const { return collected_.size(); }
  bool empty() const { return collected_.empty(); }

  /// Moves the collected items out and leaves the list empty. Thread safety: one thread.
  UnsetVector<T> take() { return std::exchange(collected_, {}); }

  /// Forgets all items and keeps the memory. Thread safety: one thread.
  void clear() {
    clear_lanes();
    collected_.clear();
  }

 private:
  /// A stretch's items, and where they go.
  struct Run {
    detail::Stretch stretch;
    T* from;
    std::size_t count, to;
  };

  std::vector<Run> runs_in_order();
  void copy(const std::vector<Run>& runs, T* to);

  void clear_lanes() {
    for (std::size_t t = 0; t < lanes_.size(); ++t) {
      lanes_[t].items.clear();
      lanes_[t].stretches.clear();
    }
  }

  Executor executor_;
  PerThread<detail::WorkLane<T>> lanes_;
  UnsetVector<T> collected_;
};

template <WorkItem T>
auto Worklist<T>::runs_in_order() -> std::vector<Run> {
  std::vector<Run> runs;
  for (std::size_t t = 0; t < lanes_.size(); ++t) {
    std::size_t end = lanes_[t].items.size();
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

/// All threads copy an equal part each, wherever runs begin and end.
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
      if (!lanes_[t].items.empty()) collected_.swap(lanes_[t].items);
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

/// What a loop finds: calls find(i, append) for i in [0, n); append(item) adds an item to the
/// result, in which items of a lower i come first. Fewer than `serial_below` indices are looked at
/// by the caller alone. Thread safety: one caller; runs on the executor.
template <WorkItem Item, class Find>
UnsetVector<Item> parallel_collect(const Executor& executor, std::size_t n, Find&& find,
                                   std::size_t serial_below = 0) {
  Worklist<Item> found(executor);
  parallel_for(executor, n, with(found),
               [&](std::size_t i, const Appender<Item>& mine) {
                 find(i, [&mine](Item item) { mine.append(std::move(item)); });
               },
               {.serial_below = serial_below});
  found.collect();
  return found.take();
}

}  // namespace ductile::runtime
