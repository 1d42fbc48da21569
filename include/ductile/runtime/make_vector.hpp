/// @file
/// make_vector: a vector of zeros whose memory an executor's threads touch first. Fresh memory is
/// cleared by the system page by page, which takes longer than all else that is done to it once:
/// one thread alone would hold up the others, and have all pages near itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {

namespace detail {

/// Writes where nothing lives yet, which sanitizers need not know.
[[gnu::no_sanitize_address]] inline void clear_byte(std::byte* at) {
  *static_cast<volatile std::byte*>(at) = std::byte{0};
}

/// Writes to each page of memory that nothing lives in yet.
inline void touch_pages(const Executor& executor, void* memory, std::size_t bytes) {
  constexpr std::size_t page = 4096, few = 64;
  if (executor.threads() == 1 || bytes < few * page) return;
  auto* const first = static_cast<std::byte*>(memory);
  parallel_for(executor, bytes / page, [first](std::size_t i) { clear_byte(first + i * page); },
               {.grain = 16});
}

}  // namespace detail

/// Resizes a vector that holds nothing. Throws std::bad_alloc.
/// Thread safety: one caller; runs on the executor.
template <class T>
void resize_empty(const Executor& executor, std::vector<T>& empty, std::size_t n) {
  empty.reserve(n);
  detail::touch_pages(executor, empty.data(), n * sizeof(T));
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
