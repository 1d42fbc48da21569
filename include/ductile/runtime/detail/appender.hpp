/// @file
/// Appender: one thread's access to a Worklist, with minimal cost per item. A thread appends to its
/// own array and notes which items came from which range of iterations.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

/// Items are moved where exceptions are not allowed. They need not be copyable.
template <class T>
concept WorkItem = std::movable<T> && std::is_nothrow_move_constructible_v<T>;

namespace detail {

/// Items from `first` on were appended in iterations [begin, end) of a loop, in order.
struct Stretch {
  std::uint64_t loop;
  std::size_t begin, end;  // iterations
  std::size_t first;       // item
};

/// One thread's items, the first `used` of the array. The rest is uninitialised; arrays of types
/// that are not trivially copyable have no rest.
template <class T>
struct WorkLane {
  static constexpr bool has_rest = std::is_trivially_copyable_v<T>;

  UnsetVector<T> items;
  std::size_t used = 0;
  std::vector<Stretch> stretches;
  bool lent = false;

  /// Notes the calling thread's position, where the next items come from. Throws std::bad_alloc.
  void note_place() {
    const LoopPlace& place = loop_place;
    if (!stretches.empty()) {
      Stretch& last = stretches.back();
      const bool same_loop = last.loop == place.loop;
      if (same_loop && last.begin <= place.begin && place.end <= last.end) return;
      if (same_loop && last.end == place.begin) {  // continues the last range
        last.end = place.end;
        return;
      }
      if (last.first == used) stretches.pop_back();
    }
    stretches.push_back({place.loop, place.begin, place.end, used});
  }

  /// Throws std::bad_alloc.
  [[gnu::noinline]] void grow() {
    items.reserve(std::max<std::size_t>(2 * used, 64));
    items.resize(items.capacity());
  }

  void clear() {
    if constexpr (!has_rest) items.clear();
    stretches.clear();
    used = 0;
  }
};

}  // namespace detail

/// One thread's access to a Worklist, from Worklist::mine(). Thread safety: that thread, while it
/// runs the range of iterations for which it asked.
template <WorkItem T>
class Appender {
 public:
  explicit Appender(detail::WorkLane<T>& lane) : lane_(lane) {
    lane_.lent = true;
    find_room();
  }
  ~Appender() {
    lane_.used =
        has_rest ? static_cast<std::size_t>(next_ - lane_.items.data()) : lane_.items.size();
    lane_.lent = false;
  }
  Appender(const Appender&) = delete;
  Appender& operator=(const Appender&) = delete;

  /// If it throws std::bad_alloc, or what copying the item throws, the item is not appended.
  template <class U = T>
  requires std::constructible_from<T, U>
  void append(U&& item) {
    if constexpr (has_rest) {
      if (next_ == end_) [[unlikely]]
        make_room();
      std::construct_at(next_, std::forward<U>(item));
      ++next_;
    } else {
      lane_.items.emplace_back(std::forward<U>(item));
    }
  }

 private:
  static constexpr bool has_rest = detail::WorkLane<T>::has_rest;

  void find_room() {
    next_ = lane_.items.data() + lane_.used;
    end_ = lane_.items.data() + lane_.items.size();
  }
  void make_room() {
    lane_.used = lane_.items.size();
    lane_.grow();
    find_room();
  }

  detail::WorkLane<T>& lane_;
  T* next_;  // here, not in the lane, so that loops keep them in registers
  T* end_;
};

}  // namespace ductile::runtime
