/// @file
/// atomic_mark: many threads set flags of an ordinary array. In one phase of a loop such a flag is
/// accessed through these functions only.
#pragma once

#include <atomic>
#include <cstdint>

namespace ductile::runtime {

/// Sets the flag to 1. Relaxed, as all write the same value: the barrier at the end of the loop
/// orders it before whoever reads. A flag that is set already is not written, so its cache line
/// stays shared. Thread safety: any thread.
inline void atomic_mark(std::uint8_t& flag) {
  const std::atomic_ref word(flag);
  if (word.load(std::memory_order_relaxed) == 0) word.store(1, std::memory_order_relaxed);
}

/// Is the flag set, as far as this thread knows? Thread safety: any thread.
inline bool atomic_is_marked(std::uint8_t& flag) {
  return std::atomic_ref(flag).load(std::memory_order_relaxed) != 0;
}

/// Sets a flag where few threads set flags that lie near each other: one of a random pattern is set
/// faster than looked at. Thread safety: any thread.
inline void atomic_set(std::uint8_t& flag) {
  std::atomic_ref(flag).store(1, std::memory_order_relaxed);
}

}  // namespace ductile::runtime
