/// @file
/// Buckets: many append-only lists that one thread fills, each in chunks that double in length, so
/// that elements never move and memory is kept from one filling to the next.
/// An append looks up two pointers only: where the list's next element goes, and where its chunk
/// ends. Those of all lists lie side by side, apart from what else there is to know of a list.
/// Thread safety: one thread at a time; where it says so, one thread at a time for each list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace ductile::runtime::detail {

/// Where the next element of a list goes and where its chunk ends; equal if it wants a chunk first.
struct Room {
  void* next = nullptr;
  void* end = nullptr;
};

/// Leaves one of each number, in ascending order.
void sort_and_make_unique(std::vector<std::uint32_t>& numbers);

template <class T>
class Buckets {
 public:
  Buckets() = default;
  ~Buckets() { release(); }
  Buckets(const Buckets&) = delete;
  Buckets& operator=(const Buckets&) = delete;

  /// Makes `count` empty lists. Precondition: there are none. Throws std::bad_alloc; there may be
  /// none then, or all.
  void provide(std::size_t count) {
    touched_.reserve(count);
    lists_.resize(count);
    rooms_.resize(count);
  }

  /// Those of the lists. Whoever puts an element at `next` moves that on.
  Room* rooms() { return rooms_.data(); }

  /// Starts a list's next chunk. Throws std::bad_alloc and changes nothing then.
  void grow(std::uint32_t number) {
    List& list = lists_[number];
    if (list.used == list.chunks.size()) add_chunk(list);
    if (list.used == 0) touched_.push_back(number);  // cannot throw: provide() reserved
    const auto& [begin, end] = list.chunks[list.used++];
    rooms_[number] = {begin, end};
  }

  /// Numbers of the lists that may have elements, in no order.
  std::span<const std::uint32_t> touched() const { return touched_; }

  std::size_t size() const {
    std::size_t sum = 0;
    const auto add = [&](const T* begin, const T* end) {
      sum += static_cast<std::size_t>(end - begin);
    };
    for (const std::uint32_t number : touched_) for_each_chunk(number, add);
    return sum;
  }

  /// Calls visit(begin, end) for each chunk of a list, in the order of its elements.
  /// Thread safety: one thread at a time for each list.
  template <class Visit>
  void for_each_chunk(std::uint32_t number, Visit&& visit) const {
    if (lists_.empty()) return;
    const List& list = lists_[number];
    for (std::size_t c = 0; c < list.used; ++c) {
      const auto& [begin, end] = list.chunks[c];
      visit(begin, c + 1 == list.used ? static_cast<T*>(rooms_[number].next) : end);
    }
  }

  /// Removes a list's elements and keeps its memory; the list stays among those touched.
  /// Thread safety: one thread at a time for each list.
  void clear(std::uint32_t number) {
    if (lists_.empty()) return;
    if constexpr (!std::is_trivially_destructible_v<T>)
      for_each_chunk(number, [](T* begin, T* end) { std::destroy(begin, end); });
    lists_[number].used = 0;
    rooms_[number] = {};
  }

  /// Removes all elements and keeps the memory.
  void clear() {
    for (const std::uint32_t number : touched_) clear(number);
    touched_.clear();
  }

  /// Removes all elements and lists and gives the memory back.
  void release() {
    clear();
    for (const List& list : lists_)
      for (const auto& [begin, end] : list.chunks)
        std::allocator<T>().deallocate(begin, static_cast<std::size_t>(end - begin));
    std::vector<Room>().swap(rooms_);
    std::vector<List>().swap(lists_);
    std::vector<std::uint32_t>().swap(touched_);
  }

 private:
  struct Chunk {
    T *begin, *end;
  };
  struct List {
    std::vector<Chunk> chunks;
    std::size_t used = 0;  // chunks with elements, or about to get some
  };

  static constexpr std::size_t first_capacity = std::max<std::size_t>(1, 512 / sizeof(T));
  static constexpr std::size_t last_capacity = std::max<std::size_t>(1, 65536 / sizeof(T));

  static void add_chunk(List& list) {
    std::vector<Chunk>& chunks = list.chunks;
    std::size_t capacity = first_capacity;
    if (!chunks.empty())
      capacity = 2 * static_cast<std::size_t>(chunks.back().end - chunks.back().begin);
    capacity = std::min(capacity, last_capacity);
    chunks.emplace_back();
    try {
      T* const begin = std::allocator<T>().allocate(capacity);
      chunks.back() = {begin, begin + capacity};
    } catch (...) {
      chunks.pop_back();
      throw;
    }
  }

  std::vector<Room> rooms_;  // [list]
  std::vector<List> lists_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace ductile::runtime::detail
