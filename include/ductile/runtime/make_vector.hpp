/// @file
/// make_vector: a vector of zeros whose memory an executor's threads touch first. Fresh memory is
/// cleared by the system page by page, which takes longer than all else that is done to it once:
/// one thread alone would hold up the others, and have all pages near itself.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/fresh_memory.hpp"

namespace ductile::runtime {

/// Resizes a vector that holds nothing. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
void resize_empty(const Executor& executor, std::vector<T>& empty, std::size_t n) {
  empty.reserve(n);
  touch_pages(executor, empty.data(), n * sizeof(T));
  empty.resize(n);
}

/// n default values, zeros for numbers. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
std::vector<T> make_vector(const Executor& executor, std::size_t n) {
  std::vector<T> made;
  resize_empty(executor, made, n);
  return made;
}

}  // namespace ductile::runtime
