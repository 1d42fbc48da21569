#include "ductile/runtime/parallel_for.hpp"

#include <algorithm>
#include <utility>

#include "loop.hpp"

namespace ductile::runtime {

namespace detail {
constinit thread_local int current_thread = 0;
}

namespace {

thread_local bool inside_loop = false;

/// Long enough to hide the cost of taking a chunk, short enough to balance the load to a percent.
std::size_t chosen_grain(std::size_t n, int threads) {
  return std::clamp<std::size_t>(n / (128 * static_cast<std::size_t>(threads)), 1, 256);
}

/// A loop inside another one, or too short to share. It keeps the number of the thread, so that
/// per-thread data of the outer loop stay this thread's, unless its executor has no such thread.
void run_alone(const Executor& executor, std::size_t n, RangeBody body, void* context) {
  const int thread = detail::current_thread;
  const TeamMember member(thread < executor.threads() ? thread : 0);
  body(context, 0, n);
}

}  // namespace

bool inside_a_loop() noexcept { return inside_loop; }

TeamMember::TeamMember(int thread) noexcept
    : thread_before_(std::exchange(detail::current_thread, thread)),
      inside_before_(std::exchange(inside_loop, true)) {}

TeamMember::~TeamMember() {
  detail::current_thread = thread_before_;
  inside_loop = inside_before_;
}

void run_loop(const Executor& executor, std::size_t n, RangeBody body, void* context,
              const LoopOptions& options) {
  if (n == 0) return;
  const std::size_t grain = options.grain ? options.grain : chosen_grain(n, executor.threads());
  if (executor.threads() == 1 || n <= grain || n < options.serial_below || inside_loop) {
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
    case Schedule::automatic:  // the one that measures best in every shape of loop
    case Schedule::steal_by_atomics:
      run_steal_by_atomics(executor, loop);
      break;
  }
  loop.error.rethrow();
}

}  // namespace ductile::runtime
