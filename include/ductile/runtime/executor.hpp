/// @file
/// Executor: how parallel work runs: how many threads, where they are placed, how loops are
/// divided, and whether results may depend on timing. A program makes one and passes it down; the
/// library has no other global state. Threads are OpenMP's, which spin by default while they wait:
/// run loops in with_team(), or set OMP_WAIT_POLICY=passive.
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
  automatic,         ///< stealing by atomics, the fastest for every kind of loop measured
  omp_static,        ///< OpenMP's static: equal contiguous parts
  omp_dynamic,       ///< OpenMP's dynamic with the loop's grain
  omp_guided,        ///< OpenMP's guided with the loop's grain
  steal_by_signal,   ///< an idle thread interrupts the one with most work left, which gives half
                     ///< away; nanosleep() and the like in a body may end early with EINTR. Uses
                     ///< atomics if the caller blocks all real-time signals
  steal_by_atomics,  ///< an idle thread takes half of a victim's range by compare-and-swap
};

/// Where threads are placed on the machine. Each thread is bound to a processing unit while it
/// works on a loop and gets its previous affinity back afterwards, so neither the caller's thread
/// nor OpenMP's stay bound. Only units the process may use count; they are reused if there are more
/// threads than units.
enum class Placement {
  none,     ///< the operating system decides; affinities are not touched
  compact,  ///< close together; physical cores before their second hyperthreads
  scatter,  ///< alternating packages, for memory bandwidth; physical cores first
};

/// Number of threads of an Executor, their placement, and the schedule of loops.
struct ExecutorOptions {
  int threads = 0;  ///< 0: as many as the cores this process may use
  Placement placement = Placement::none;
  Schedule schedule = Schedule::automatic;
  bool deterministic = true;  ///< results do not depend on thread count or timing
};

/// Cheap to copy. Thread safety: any thread; several threads may run loops on one Executor at once.
class Executor {
 public:
  /// With a placement, reads the machine's topology, which takes some milliseconds; threads stay
  /// unbound if it is hidden or binding is refused. Throws std::invalid_argument if options.threads
  /// is negative or above 4096.
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

/// Number of cores this process may use, at least 1: those in the affinity mask, or fewer if
/// cgroups limit its processor time to less.
int available_cores();

// ---- Threads that stay together from one loop to the next ----
//
// Without a team, each loop starts and joins OpenMP's threads, which takes microseconds. In a team,
// a thread that has done its part waits for the next loop, and a loop costs one message to each
// thread and one back. Programs with thousands of short loops, such as adapt(), gain most, and so
// does any program on a shared machine (see parallel_for.hpp). Runtime algorithms with many loops,
// such as colour() and run_rounds(), form a team themselves.

/// Type-erased body of with_team().
using TeamBody = void (*)(void* context);

/// Type-erased with_team().
void run_with_team(const Executor& executor, TeamBody body, void* context);

/// Calls body() on the calling thread; all loops it starts there with this executor, or a copy, run
/// on threads that stay together until body() ends. Loops give the same results as without a team.
/// Threads waiting for the next loop spin for 50 microseconds (up to 200 in large teams; not at all
/// if they outnumber the cores) and then sleep. With a placement, all of them including the caller
/// are bound until body() ends. The calling thread is then in an OpenMP parallel region: loops of
/// other executors and parallel regions that body() begins run on it alone. Returns what body()
/// returns; its exceptions reach the caller. Inside a loop or another team, or for one thread, only
/// calls body(). Thread safety: any thread; each caller has its own team.
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

/// with_team() for loops over so many items; a few are done before a team has formed.
template <class Body>
auto with_team_for(std::size_t items, const Executor& executor, Body&& body) {
  constexpr std::size_t few = 256;
  return items < few ? body() : with_team(executor, body);
}

}  // namespace detail

}  // namespace ductile::runtime
