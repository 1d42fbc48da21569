/// @file
/// Buckets: many append-only lists filled by one thread, each in chunks that double in length, so
/// that elements never move and memory is reused. All chunks lie in a few blocks, which are quick
/// to free.
/// An append reads only two pointers: the list's next element and the end of its chunk. These are
/// stored for all lists together, apart from other data.
/// Thread safety: one thread at a time; where noted, one thread at a time for each list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <type_traits>
#include <vector>

namespace ductile::runtime::detail {

/// A bit field chosen at run time: maps an owner to its bucket's number. It is extracted by one
/// instruction on processors with BMI, by two elsewhere; its layout is the same for both. Thread
/// safety: pure functions.
class BitField {
 public:
  BitField() = default;  ///< none
  /// `count` bits from `first` on. Precondition: 1 <= first, first + count <= 32.
  BitField(unsigned first, unsigned count)
      : control_(first | count << 8U), mask_((std::uint32_t{1} << count) - 1) {}

  std::size_t of(std::uint32_t number) const {
#if defined(__BMI__) && defined(__x86_64__)
    return __builtin_ia32_bextr_u64(number, control_);
#else
    return (number >> (control_ & 31U)) & mask_;
#endif
  }

 private:
  std::uint32_t control_ = 0;  // the first bit's position; from bit 8 on, the number of bits
  std::uint32_t mask_ = 0;
};

/// The next element of each list and the end of its chunk; equal if it needs a chunk. Two arrays,
/// not one of pairs, so that a list's number is the only index to compute.
struct Rooms {
  void** next;        // [list]
  void* const* ends;  // [list]
};

template <class T>
class Buckets {
 public:
  Buckets() = default;
  ~Buckets() { release(); }
  Buckets(const Buckets&) = delete;
  Buckets& operator=(const Buckets&) = delete;

  /// Makes `count` empty lists. Precondition: there are none. If it throws std::bad_alloc, there
  /// may be none or all.
  void provide(std::size_t count) {
    rooms_.resize(2 * count);
    lists_.resize(count);  // last: lists exist only together with their rooms
  }

  /// The rooms of the lists. Whoever stores an element at a `next` advances it.
  Rooms rooms() { return {rooms_.data(), rooms_.data() + lists_.size()}; }

  /// Starts a list's next chunk. If it throws std::bad_alloc, nothing changes.
  void grow(std::uint32_t number) {
    List& list = lists_[number];
    Chunk*& next = list.last == nullptr ? list.first : list.last->next;
    if (next == nullptr) next = new_chunk(list.last);
    list.last = next;
    set_room(number, next->begin, next->end);
  }

  /// Calls visit(begin, end) for each chunk of a list, in the order of its elements.
  /// Thread safety: one thread at a time for each list.
  template <class Visit>
  void for_each_chunk(std::uint32_t number, Visit&& visit) const {
    if (lists_.empty() || lists_[number].last == nullptr) return;
    const List& list = lists_[number];
    for (Chunk* chunk = list.first; chunk != list.last; chunk = chunk->next)
      visit(chunk->begin, chunk->end);
    visit(list.last->begin, static_cast<T*>(rooms_[number]));
  }

  /// Number of elements of a list. Thread safety: one thread at a time for each list.
  std::size_t size(std::uint32_t number) const {
    std::size_t sum = 0;
    for_each_chunk(number, [&](const T* begin, const T* end) { sum += end - begin; });
    return sum;
  }

  /// Removes a list's elements and keeps its memory.
  /// Thread safety: one thread at a time for each list.
  void clear(std::uint32_t number) {
    if (lists_.empty()) return;
    if constexpr (!std::is_trivially_destructible_v<T>)
      for_each_chunk(number, [](T* begin, T* end) { std::destroy(begin, end); });
    lists_[number].last = nullptr;
    set_room(number, nullptr, nullptr);
  }

  /// Removes all elements and lists and gives the memory back.
  void release() {
    if constexpr (!std::is_trivially_destructible_v<T>)
      for (std::uint32_t number = 0; number < lists_.size(); ++number) clear(number);
    std::vector<void*>().swap(rooms_);
    std::vector<List>().swap(lists_);
    memory_.release();
  }

 private:
  struct Chunk {
    T *begin, *end;
    Chunk* next;
  };
  struct List {
    Chunk* first = nullptr;
    Chunk* last = nullptr;  // has elements or is about to get some; later chunks are kept for reuse
  };

  static constexpr std::size_t first_capacity = std::max<std::size_t>(1, 512 / sizeof(T));
  static constexpr std::size_t last_capacity = std::max<std::size_t>(1, 65536 / sizeof(T));

  void set_room(std::uint32_t number, T* next, T* end) {
    rooms_[number] = next;
    rooms_[lists_.size() + number] = end;
  }

  Chunk* new_chunk(const Chunk* before) {
    const std::size_t capacity =
        before == nullptr
            ? first_capacity
            : std::min(2 * static_cast<std::size_t>(before->end - before->begin), last_capacity);
    std::pmr::polymorphic_allocator<> allocator(&memory_);
    T* const begin = allocator.allocate_object<T>(capacity);
    return allocator.new_object<Chunk>(Chunk{begin, begin + capacity, nullptr});
  }

  std::vector<void*> rooms_;  // see Rooms: `next` of all lists, then their ends
  std::vector<List> lists_;
  std::pmr::monotonic_buffer_resource memory_;  // for chunks
};

}  // namespace ductile::runtime::detail
