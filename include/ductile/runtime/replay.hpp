/// @file
/// replay: what a recorded run would need on P threads, for P far past the cores at hand.
/// Each loop's chunks go, in order, to whichever thread is free first, as a scheduler that balances
/// does it; parts of loops wait there for those they were recorded to wait for, where real threads
/// begin others meanwhile. A loop ends with its last chunk and costs a launch; what lay between
/// loops stays serial. It knows nothing of memory: caches and bandwidth that threads share make
/// real runs slower.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "ductile/runtime/recording.hpp"

namespace ductile::runtime {

struct ReplayOptions {
  int threads = 1;
  double launch_ns = 1000;  ///< starting and joining the team once, with this many threads
  std::size_t block = 0;    ///< items handed out at once where single items were recorded; 0: as
                            ///< many as then
};

/// Times of a part of the run, in seconds.
struct ReplayTimes {
  double serial = 0;    ///< between loops: one thread, whatever P is
  double work = 0;      ///< in loops, over all threads
  double elapsed = 0;   ///< on P threads, launches and serial parts included
  double critical = 0;  ///< on any number of threads: longest chunks, launches and serial parts
  std::size_t launches = 0;

  double speedup() const { return elapsed > 0 ? (serial + work) / elapsed : 1; }
  /// The share of the threads' time that is work.
  double balance(int threads) const {
    return elapsed > 0 ? (serial + work) / elapsed / threads : 1;
  }
  ReplayTimes& operator+=(const ReplayTimes& other);
};

struct ReplaySection {
  std::string name;
  ReplayTimes total;
  std::array<ReplayTimes, phase_count> times_of;  ///< [phase]
};

struct Replay {
  int threads = 1;
  ReplayTimes total;
  std::vector<ReplaySection> sections;  ///< as first begun; [0] is what came before the first
  std::vector<ReplayTimes> rounds;      ///< every round of every run, in order
};

/// Throws std::invalid_argument if options.threads is less than 1.
/// Thread safety: any thread.
Replay replay(const Recording& recording, const ReplayOptions& options);

}  // namespace ductile::runtime
