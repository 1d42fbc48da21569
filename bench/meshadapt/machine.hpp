/// @file
/// What a figure depends on besides the program: how far apart the cores are at the moment, how
/// much memory and processor time this process took, and what the machine calls itself.
#pragma once

#include <cstddef>
#include <string>

namespace ductile::bench {

/// Nanoseconds that a cache line takes from one core to another and back: to the nearest and to the
/// farthest of those that threads run on, seen from the first. 0 on one core.
struct CoreDistance {
  double nearest_ns = 0, farthest_ns = 0;
};

/// Looks at the first `threads` processing units that this process may use (at most 16 of them).
/// Takes some milliseconds for each. A virtual machine's answer may change from minute to minute.
/// Thread safety: one caller, nothing else running.
CoreDistance core_distance(int threads);

/// What a distance means: "one core" for hyperthreads of one core, "near", "far"; "-" for 0. A pair
/// of words if the nearest and the farthest differ.
std::string placement_of(const CoreDistance& distance);

/// Forgets the most memory that was held so far, where the system can.
void reset_peak_memory();
/// The most memory held since, in bytes.
std::size_t peak_memory();

/// Processor time of all threads of this process so far, seconds.
double processor_seconds();

/// Processor, units that this process may use, compiler and flags, in one line.
std::string machine_line();

}  // namespace ductile::bench
