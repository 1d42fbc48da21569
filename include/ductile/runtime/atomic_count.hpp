/// @file
/// atomic_count: many threads count into one word of an ordinary array. In one phase of a loop
/// such a word is accessed through this function only.
#pragma once

#include <atomic>
#include <cstdint>

namespace ductile::runtime {

/// Adds n and returns the value before. Relaxed: the count carries no other data; the barrier at
/// the end of the loop orders what was written beside it. Thread safety: any thread.
inline std::uint32_t atomic_count(std::uint32_t& where, std::uint32_t n = 1) {
  return std::atomic_ref(where).fetch_add(n, std::memory_order_relaxed);
}

}  // namespace ductile::runtime
