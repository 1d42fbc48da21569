/// @file
/// Conditions that a figure depends on besides the program: the current distance between cores, the
/// memory and processor time of this process, and the description of the machine.
#pragma once

#include <cstddef>
#include <string>

namespace ductile::bench {

/// Nanoseconds for a cache line to go from the first core to another and back: to the nearest and
/// to the farthest core in use. 0 on one core.
struct CoreDistance {
  double nearest_ns = 0, farthest_ns = 0;
};

/// Measures the first `threads` processing units that this process may use (at most 16), in some
/// milliseconds each. On a virtual machine the result may change from minute to minute. Thread
/// safety: one caller, nothing else running.
CoreDistance core_distance(int threads);

/// A word for a distance: "one core" for hyperthreads of one core, "near", "far"; "-" for 0. Two
/// words if the nearest and the farthest differ.
std::string placement_of(const CoreDistance& distance);

/// Resets the peak memory of this process, where the system can.
void reset_peak_memory();
/// Peak memory since then, in bytes.
std::size_t peak_memory();

/// Processor time of all threads of this process so far, seconds.
double processor_seconds();

/// Processor, units that this process may use, compiler and flags, in one line.
std::string machine_line();

}  // namespace ductile::bench
