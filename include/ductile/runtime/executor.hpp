/// @file
/// Executor: how parallel work is run: how many threads, where they sit, how loops are shared out,
/// and whether results may depend on timing. A program makes one and passes it down; the library
/// has no global state besides it. Threads are OpenMP's, which by default spin where they wait: a
/// program runs its loops in with_team(), or sets OMP_WAIT_POLICY=passive.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

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

/// How many threads an Executor has, where they run and how they share out loops.
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

// ---- Threads that stay together from one loop to the next ----
//
// Without a team, each loop starts and joins OpenMP's threads, which takes microseconds; in one a
// thread that has done its part waits for the next loop, and a loop takes a message to each thread
// and one back. Programs that run short loops by the thousand, such as adapt(), gain most; so does
// every program on a machine that others use too, see loops in parallel_for.hpp. Algorithms of the
// runtime that run many loops, such as colour() and run_rounds(), form a team by themselves.

/// What with_team() calls, without its type.
using TeamBody = void (*)(void* context);

/// with_team() without types.
void run_with_team(const Executor& executor, TeamBody body, void* context);

/// Calls body() on the calling thread; all loops that it starts there with this executor, or a copy
/// of it, run on threads that stay together until body() is done. What loops do is the same as
/// without a team. Threads that wait for the next loop spin for 50 microseconds, in large teams for
/// up to 200, or not at all where there are more of them than cores, and then sleep. With a
/// placement they are bound, the calling one too, until body() is done. Meanwhile the thread is
/// within a parallel region of OpenMP's: loops of other executors, and parallel regions that body()
/// begins itself, run on it alone. What body() returns is returned, and what it throws reaches the
/// caller. Inside a loop or another team, or for one thread, body() is called and that is all.
/// Thread safety: any thread; each that calls it has a team of its own.
template <class Body>
auto with_team(const Executor& executor, Body&& body) {
  using Plain = std::remove_reference_t<Body>;
  using Result = std::decay_t<std::invoke_result_t<Plain&>>;
  if constexpr (std::is_void_v<Result>) {
    run_with_team(
        executor, [](void* context) { (*static_cast<Plain*>(context))(); },
        const_cast<std::remove_const_t<Plain>*>(&body));
  } else {
    std::optional<Result> result;
    with_team(executor, [&] { result.emplace(body()); });
    return *std::move(result);
  }
}

namespace detail {

/// with_team() for loops over so many items: few are done before a team has come together.
template <class Body>
auto with_team_for(std::size_t items, const Executor& executor, Body&& body) {
  constexpr std::size_t few = 256;
  return items < few ? body() : with_team(executor, body);
}

}  // namespace detail

}  // namespace ductile::runtime
