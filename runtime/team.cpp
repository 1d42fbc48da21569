#include "team.hpp"

#include <omp.h>

#include <algorithm>
#include <utility>

#include "ductile/runtime/team.hpp"
#include "loop.hpp"

namespace ductile::runtime {

namespace {

constexpr std::size_t children = 4;
constexpr int spins_while_alone = 2000;  // some ten microseconds

thread_local Team* led_team = nullptr;

/// Tells the processor that its thread waits: its other thread may go ahead.
void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

Team::Team(const Executor& executor)
    : executor_(executor),
      spins_(executor.threads() > omp_get_num_procs() ? 0 : spins_while_alone),
      seats_(std::make_unique<Seat[]>(static_cast<std::size_t>(executor.threads()))) {}

Team* Team::of(const Executor& executor) noexcept {
  Team* const team = led_team;
  if (team == nullptr || team->executor_.threads() != executor.threads() ||
      team->executor_.places() != executor.places())
    return nullptr;
  return team;
}

Team::Leading::Leading(Team& team, int size) noexcept : team_(team) {
  team.size_ = static_cast<std::size_t>(size);
  led_team = &team;
}

Team::Leading::~Leading() {
  led_team = nullptr;
  team_.call(0, ++team_.loops_, nullptr, nullptr);
}

void Team::run(Work work, void* context) {
  const std::uint32_t loop = ++loops_;
  call(0, loop, work, context);
  work(context, 0);
  await(0, loop);
}

void Team::serve(int thread) {
  const auto own = static_cast<std::size_t>(thread);
  Seat& seat = seats_[own];
  for (std::uint32_t loop = 1;; ++loop) {
    wait_until(seat.called, loop);
    const Work work = seat.work;
    call(own, loop, work, seat.context);
    if (work == nullptr) return;
    work(seat.context, thread);
    await(own, loop);
    // Sequentially consistent, as notify_one() looks for somebody who waits after that.
    seat.done.store(loop);
    seat.done.notify_one();
  }
}

/// Passes the work on to those whom `caller` calls.
void Team::call(std::size_t caller, std::uint32_t loop, Work work, void* context) {
  const std::size_t end = std::min(size_, children * caller + children + 1);
  for (std::size_t t = children * caller + 1; t < end; ++t) {
    seats_[t].work = work;
    seats_[t].context = context;
    seats_[t].called.store(loop);  // as in serve()
    seats_[t].called.notify_one();
  }
}

/// Waits for those whom `caller` has called.
void Team::await(std::size_t caller, std::uint32_t loop) {
  const std::size_t end = std::min(size_, children * caller + children + 1);
  for (std::size_t t = children * caller + 1; t < end; ++t) wait_until(seats_[t].done, loop);
}

/// Acquires what was written before the counter.
void Team::wait_until(const std::atomic<std::uint32_t>& counter, std::uint32_t loop) const {
  for (int spin = 0; spin < spins_; ++spin) {
    if (counter.load(std::memory_order_acquire) == loop) return;
    pause();
  }
  for (std::uint32_t now = 0; (now = counter.load(std::memory_order_acquire)) != loop;)
    counter.wait(now, std::memory_order_acquire);
}

void run_with_team(const Executor& executor, TeamBody body, void* context) {
  if (executor.threads() == 1 || executor.recording() != nullptr || led_team != nullptr ||
      inside_a_loop())
    return body(context);
  Team team(executor);
  FirstError error;
#pragma omp parallel num_threads(executor.threads())
  {
    const int thread = omp_get_thread_num();
    const detail::ScopedBinding binding(executor.places(), thread);
    if (thread != 0) {
      team.serve(thread);
    } else {
      const Team::Leading leading(team, omp_get_num_threads());
      try {
        body(context);
      } catch (...) {
        error.keep_current();
      }
    }
  }
  error.rethrow();
}

}  // namespace ductile::runtime
