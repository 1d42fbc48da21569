/// @file
/// How much memory this process holds, and may hold: its own, whatever its parent held before.
#pragma once

#include <cstddef>

namespace ductile::runtime {

/// Bytes that this process holds now, or the most it has held so far; 0 where that is not told.
/// Thread safety: any thread.
std::size_t held_memory();
std::size_t peak_memory();

/// Bytes that this process may hold: the machine's memory, what it swaps out included, or less
/// where cgroups or RLIMIT_DATA allow less; 0 where that is not told. Thread safety: any thread.
std::size_t most_memory();

}  // namespace ductile::runtime
