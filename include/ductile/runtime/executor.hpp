/// @file
/// Executor: how parallel work is run: how many threads, where they sit, how loops are shared out,
/// and whether results may depend on timing. A program makes one and passes it down; the library
/// has no global state besides it.
#pragma once

#include <cstdint>

namespace ductile::runtime {

/// How the iterations of a loop are shared among threads.
enum class Schedule {
  automatic,         ///< whichever measured best for the loop at hand
  omp_static,        ///< OpenMP's static: equal contiguous parts
  omp_dynamic,       ///< OpenMP's dynamic with the loop's grain
  omp_guided,        ///< OpenMP's guided with the loop's grain
  steal_by_signal,   ///< an idle thread interrupts the one with most work left, which gives half away
  steal_by_atomics,  ///< an idle thread takes half of a victim's range by compare-and-swap
};

/// Where threads are placed on the machine.
enum class Placement {
  none,     ///< wherever the operating system likes
  compact,  ///< near each other, physical cores before their second hyperthreads
  scatter,  ///< far from each other, for memory bandwidth
};

struct ExecutorOptions {
  int threads = 0;  ///< 0: as many as the cores this process may use
  Placement placement = Placement::none;
  Schedule schedule = Schedule::automatic;
  bool deterministic = true;  ///< results do not depend on thread count or timing
};

class Executor {
 public:
  /// Throws std::invalid_argument if options.threads is negative or above 4096.
  explicit Executor(const ExecutorOptions& options = {});

  int threads() const { return options_.threads; }
  Placement placement() const { return options_.placement; }
  Schedule schedule() const { return options_.schedule; }
  bool deterministic() const { return options_.deterministic; }

 private:
  ExecutorOptions options_;
};

/// The cores this process may use (affinity mask and cgroup quota respected), at least 1.
int available_cores();

}  // namespace ductile::runtime
