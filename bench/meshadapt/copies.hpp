/// @file
/// Copies: the throughput of several independent programs at once, which is an upper bound for the
/// speed-up of one program's threads.
#pragma once

#include <functional>
#include <string>

namespace ductile::bench {

/// Throughput of `copies` simultaneous copies of a single-threaded program, relative to one.
struct CopiesRow {
  std::string case_name;
  int copies = 1;
  double speed = 1;
};

/// Runs `work`, which starts no threads and returns its seconds, in one process and in `copies`
/// simultaneous ones, three times alternating, and compares medians. Throws std::runtime_error if
/// the system refuses a process or the work fails in one. Thread safety: one caller, nothing else
/// running.
double speed_of_copies(const std::function<double()>& work, int copies);

}  // namespace ductile::bench
