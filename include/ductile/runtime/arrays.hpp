/// @file
/// Arrays whose memory an executor's threads touch first. The system gives fresh memory, and clears
/// it, page by page as it is first written, with an interrupt of the program for each: 1.4 us on
/// one virtual machine, 11 on another, where a page among many takes 0.65. That takes longer than
/// everything that is done to it once: one thread alone would hold up the others, and have all
/// pages near itself. So pages are asked for many at a time, by all threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

// ---- Pages ----

/// Memory of which the pages are to be asked for.
class FreshMemory {
 public:
  /// All of this memory, which is valid until touch(), is about to be written. As many pages as it
  /// could fill are asked for, from the one on that it begins in. What they hold stays. Throws
  /// std::bad_alloc.
  void add(void* memory, std::size_t bytes);

  /// Gets the pages of all that was added. Where the system cannot do that, which is not Linux or
  /// before 5.14, they come as they are written. Thread safety: one caller; runs on the executor.
  void touch(const Executor& executor);

 private:
  struct Pages {
    std::byte* begin;
    std::size_t count;
  };
  std::vector<Pages> parts_;
};

namespace detail {

/// Whether memory that malloc or new gave, which often has had it before, is worth touching: there
/// is some of it, and its last page is not there. Thread safety: any thread.
bool is_fresh(void* memory, std::size_t bytes);

/// Gets pages as FreshMemory does, for the thread that is about to write them.
/// Thread safety: any thread.
void get_pages(void* memory, std::size_t bytes);

/// Gets the pages of memory if it is fresh. Thread safety: as FreshMemory::touch().
void touch_pages(const Executor& executor, void* memory, std::size_t bytes);

}  // namespace detail

/// Calls write(begin, end) with parts of the n elements at `first`, each on the thread that gets
/// its pages before, if the elements are fresh. Thread safety: as FreshMemory::touch().
template <class T, class Write>
void write_first(const Executor& executor, T* first, std::size_t n, Write&& write,
                 const LoopOptions& options) {
  const bool fresh = detail::is_fresh(first, n * sizeof(T));
  parallel_for_ranges(
      executor, n,
      [&](std::size_t begin, std::size_t end) {
        if (fresh) detail::get_pages(first + begin, (end - begin) * sizeof(T));
        write(first + begin, first + end);
      },
      options);
}

// ---- Vectors ----

/// std::allocator, but that an element made of nothing may hold anything, if its type is trivially
/// copyable.
template <class T>
struct UnsetAllocator : std::allocator<T> {
  UnsetAllocator() = default;
  template <class U>
  UnsetAllocator(const UnsetAllocator<U>&) noexcept {}

  template <class U>
  void construct(U* place) noexcept(std::is_nothrow_default_constructible_v<U>) {
    if constexpr (!std::is_trivially_copyable_v<U>) ::new (static_cast<void*>(place)) U();
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
};

/// A vector whose resize() leaves numbers, and everything that can be copied byte by byte, unset. A
/// std::vector sets them on one thread, while the others wait to fill them.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

/// n unset elements, all of which are about to be set. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
UnsetVector<T> make_unset_vector(const Executor& executor, std::size_t n) {
  UnsetVector<T> made;
  made.reserve(n);
  detail::touch_pages(executor, made.data(), n * sizeof(T));
  made.resize(n);
  return made;
}

/// A vector that holds nothing, and the size that it is to have.
template <class T>
struct EmptyVector {
  std::vector<T>& vector;
  std::size_t size;
};
template <class T>
EmptyVector(std::vector<T>&, std::size_t) -> EmptyVector<T>;

/// Resizes vectors; what is large, side by side. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class... T>
void resize_empty(const Executor& executor, const EmptyVector<T>&... empty) {
  constexpr std::size_t large = std::size_t{1} << 17U;
  (empty.vector.reserve(empty.size), ...);
  (detail::touch_pages(executor, empty.vector.data(), empty.size * sizeof(T)), ...);
  const auto resize = [&](std::size_t which) {
    std::size_t i = 0;
    ((i++ == which ? empty.vector.resize(empty.size) : void()), ...);
  };
  const bool is_large = ((empty.size * sizeof(T)) + ...) >= large;
  parallel_for(executor, sizeof...(T), resize,
               {.grain = 1, .serial_below = is_large ? 0 : sizeof...(T) + 1});
}

/// n default values, zeros for numbers. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
std::vector<T> make_vector(const Executor& executor, std::size_t n) {
  std::vector<T> made;
  resize_empty(executor, EmptyVector{made, n});
  return made;
}

/// Grows an array to n elements, if it has fewer: what is new holds `value`, and what there was is
/// moved and what is new written by all threads. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
requires std::is_trivially_copyable_v<T>
void grow_filled(const Executor& executor, UnsetVector<T>& array, std::size_t n,
                 std::type_identity_t<T> value) {
  constexpr std::size_t pages = std::max<std::size_t>(1, 32768 / sizeof(T));
  constexpr LoopOptions by_pages{.grain = pages, .serial_below = 4 * pages};
  const std::size_t before = array.size();
  if (n <= before) return;
  if (n > array.capacity()) {
    UnsetVector<T> larger;
    larger.reserve(std::max(n, array.capacity() + array.capacity() / 2));
    larger.resize(before);
    const auto move = [&](std::size_t begin, std::size_t end) {
      std::copy(array.data() + begin, array.data() + end, larger.data() + begin);
    };
    parallel_for_ranges(executor, before, move, by_pages);
    array.swap(larger);
  }
  array.resize(n);
  const auto fill = [value](T* begin, T* end) { std::fill(begin, end, value); };
  write_first(executor, array.data() + before, n - before, fill, by_pages);
}

/// n elements that hold `value`, written by all threads. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
UnsetVector<T> make_filled(const Executor& executor, std::size_t n,
                           std::type_identity_t<T> value = {}) {
  UnsetVector<T> made;
  grow_filled(executor, made, n, value);
  return made;
}

}  // namespace ductile::runtime
