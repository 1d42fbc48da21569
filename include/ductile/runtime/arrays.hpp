/// @file
/// Arrays whose memory an executor's threads touch first. The system provides and clears fresh
/// memory page by page on first write, with a page fault for each: 1.4 us on one virtual machine,
/// 11 on another; a page requested in bulk takes 0.65. This takes longer than anything done once to
/// the array, and a single thread would also place all pages near itself. So all threads request
/// many pages at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

// ---- Pages ----

/// Memory whose pages are to be requested in advance.
class FreshMemory {
 public:
  /// Announces that this memory, which stays valid until touch(), is about to be written. Requests
  /// as many pages as it could fill, starting with the one it begins in. Contents are kept. Throws
  /// std::bad_alloc.
  void add(void* memory, std::size_t bytes);

  /// Gets the pages of all added memory. Where the system cannot do that (not Linux, or Linux
  /// before 5.14), pages come as they are written. Thread safety: one caller; runs on the executor.
  void touch(const Executor& executor);

 private:
  struct Pages {
    std::byte* begin;
    std::size_t count;
  };
  std::vector<Pages> parts_;
};

namespace detail {

/// Is this memory from malloc or new, which may have been used before, worth touching? True if it
/// is not empty and its last page is not resident. Thread safety: any thread.
bool is_fresh(void* memory, std::size_t bytes);

/// Gets pages as FreshMemory does, for the thread that is about to write them.
/// Thread safety: any thread.
void get_pages(void* memory, std::size_t bytes);

/// Gets the pages of memory if it is fresh. Thread safety: as FreshMemory::touch().
void touch_pages(const Executor& executor, void* memory, std::size_t bytes);

}  // namespace detail

/// Calls write(begin, end) on parts of the n elements at `first`; if they are fresh, each thread
/// first gets the pages of its part. Thread safety: as FreshMemory::touch().
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

/// std::allocator, except that value-initialised elements of trivially copyable types are left
/// uninitialised.
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

/// A vector whose resize() leaves trivially copyable elements uninitialised. A std::vector would
/// set them on one thread while the others wait to fill them.
template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

/// n uninitialised elements, all of which are about to be set. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
UnsetVector<T> make_unset_vector(const Executor& executor, std::size_t n) {
  UnsetVector<T> made;
  made.reserve(n);
  detail::touch_pages(executor, made.data(), n * sizeof(T));
  made.resize(n);
  return made;
}

/// An empty vector and the size it is to get.
template <class T>
struct EmptyVector {
  std::vector<T>& vector;
  std::size_t size;
};
template <class T>
EmptyVector(std::vector<T>&, std::size_t) -> EmptyVector<T>;

/// Resizes vectors, large ones in parallel. Throws std::bad_alloc.
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

/// Grows an array to n elements if it has fewer and sets the new ones to `value`; all threads move
/// the old elements and write the new ones. Throws std::bad_alloc.
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
