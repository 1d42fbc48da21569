/// @file
/// make_vector: a vector of zeros whose memory an executor's threads touch first. Fresh memory is
/// cleared by the system page by page, which takes longer than all else that is done to it once:
/// one thread alone would hold up the others, and have all pages near itself.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/fresh_memory.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

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
  (touch_pages(executor, empty.vector.data(), empty.size * sizeof(T)), ...);
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

}  // namespace ductile::runtime
