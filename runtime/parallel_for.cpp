#include "ductile/runtime/parallel_for.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "loop.hpp"

namespace ductile::runtime {

namespace detail {

constinit thread_local LoopPlace loop_place;

void expect_loop_of(const Executor& executor, const char* what) {
  if (loop_place.threads != 0 && loop_place.threads != executor.threads())
    throw std::invalid_argument(std::string(what) + " for " + std::to_string(executor.threads()) +
                                " threads is used in a loop of an executor with " +
                                std::to_string(loop_place.threads));
}

}  // namespace detail

namespace {

/// Long enough to hide the cost of taking a chunk, short enough to balance the load within one per
/// cent.
std::size_t chosen_grain(std::size_t n, int threads) {
  return std::clamp<std::size_t>(n / (128 * static_cast<std::size_t>(threads)), 1, 256);
}

/// Runs a nested loop, or one too short to share. It keeps the thread's number, so that per-thread
/// data of the outer loop remain this thread's, unless its executor has no such thread.
void run_alone(const Executor& executor, std::size_t n, RangeBody body, void* context) {
  detail::LoopPlace place = detail::loop_place;
  if (!inside_a_loop()) place.begin = 0, place.end = n;
  place.threads = executor.threads();
  if (place.thread >= place.threads) place.thread = 0;
  const TeamMember member(place);
  body(context, 0, n);
}

}  // namespace

void run_loop(const Executor& executor, std::size_t n, RangeBody body, void* context,
              const LoopOptions& options) {
  if (n == 0) return;
  if (!inside_a_loop()) ++detail::loop_place.loop;
  const std::size_t grain = options.grain ? options.grain : chosen_grain(n, executor.threads());
  if (executor.threads() == 1 || n <= grain || n < options.serial_below || inside_a_loop()) {
    run_alone(executor, n, body, context);
    return;
  }
  Loop loop{body, context, n, grain};
  const Schedule schedule =
      options.schedule == Schedule::automatic ? executor.schedule() : options.schedule;
  switch (schedule) {
    case Schedule::omp_static:
      run_omp_static(executor, loop);
      break;
    case Schedule::omp_dynamic:
      run_omp_dynamic(executor, loop);
      break;
    case Schedule::omp_guided:
      run_omp_guided(executor, loop);
      break;
    case Schedule::steal_by_signal:
      run_steal_by_signal(executor, loop);
      break;
    case Schedule::automatic:  // the fastest for every kind of loop measured
    case Schedule::steal_by_atomics:
      run_steal_by_atomics(executor, loop);
      break;
  }
  loop.error.rethrow();
}

}  // namespace ductile::runtime
