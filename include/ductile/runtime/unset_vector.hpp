/// @file
/// UnsetVector: a vector whose resize() leaves numbers, and all else that can be copied byte by
/// byte, unset. A std::vector sets them on one thread, while the others wait to fill them.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/fresh_memory.hpp"

namespace ductile::runtime {

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

template <class T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

/// n unset elements, all of which are about to be set. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
UnsetVector<T> make_unset_vector(const Executor& executor, std::size_t n) {
  UnsetVector<T> made;
  made.reserve(n);
  touch_pages(executor, made.data(), n * sizeof(T));
  made.resize(n);
  return made;
}

}  // namespace ductile::runtime
