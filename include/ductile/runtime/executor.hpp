/// @file
/// Executor: how parallel work is run: how many threads, where they sit, how loops are shared out,
/// and whether results may depend on timing. A program makes one and passes it down; the library
/// has no global state besides it. Threads are OpenMP's, which by default spin where they wait: a
/// program runs its loops in with_team() (team.hpp), or sets OMP_WAIT_POLICY=passive.
#pragma once

#include <memory>

namespace ductile::runtime {

namespace detail {
class Places;
}

/// How the iterations of a loop are shared among threads.
enum class Schedule {
  automatic,         ///< stealing by atomics, which measured best in every shape of loop
  omp_static,        ///< OpenMP's static: equal contiguous parts
  omp_dynamic,       ///< OpenMP's dynamic with the loop's grain
  omp_guided,        ///< OpenMP's guided with the loop's grain
  steal_by_signal,   ///< an idle thread interrupts the one with most work left, which gives half
                     ///< away; nanosleep() and the like in a body may end early, with EINTR. By
                     ///< atomics where the caller blocks all real-time signals
  steal_by_atomics,  ///< an idle thread takes half of a victim's range by compare-and-swap
};

/// Where threads are placed on the machine. Each thread is bound to a processing unit while it
/// works on a loop, and has the affinity it had before when the loop is over: nothing is left
/// behind on the caller's thread or on OpenMP's, whatever becomes of the Executor. Units are those
/// the process may use; with more threads than units they are used again.
enum class Placement {
  none,     ///< wherever the operating system likes; affinities are not touched
  compact,  ///< near each other, physical cores before their second hyperthreads
  scatter,  ///< packages in turn, for memory bandwidth; physical cores first as well
};

struct ExecutorOptions {
  int threads = 0;  ///< 0: as many as the cores this process may use
  Placement placement = Placement::none;
  Schedule schedule = Schedule::automatic;
  bool deterministic = true;  ///< results do not depend on thread count or timing
};

/// Cheap to copy. Thread safety: any thread; several threads may run loops on one Executor at once.
class Executor {
 public:
  /// With a placement, reads the machine's topology, which takes some milliseconds; where that is
  /// hidden or binding is refused, threads are not bound. Throws std::invalid_argument if
  /// options.threads is negative or above 4096.
  explicit Executor(const ExecutorOptions& options = {});

  int threads() const { return options_.threads; }
  Placement placement() const { return options_.placement; }
  Schedule schedule() const { return options_.schedule; }
  bool deterministic() const { return options_.deterministic; }

  /// For the runtime's own use; null if threads are not bound.
  const detail::Places* places() const { return places_.get(); }

 private:
  ExecutorOptions options_;
  std::shared_ptr<const detail::Places> places_;
};

/// The cores this process may use, at least 1: the affinity mask's, or fewer if the time that
/// cgroups allow is less than that many cores'.
int available_cores();

}  // namespace ductile::runtime
