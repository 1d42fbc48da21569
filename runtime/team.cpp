#include "team.hpp"

#include <omp.h>

#include <algorithm>
#include <thread>

#include "ductile/runtime/executor.hpp"
#include "loop.hpp"

namespace ductile::runtime {

namespace {

constexpr std::size_t children = 4;
/// About the time to wake such a team, so that waiting costs no more than waking. 0 if threads
/// outnumber cores: waiting threads would occupy a core that others need.
std::chrono::microseconds spin_time(int threads) {
  constexpr int of_each = 25, least = 50, most = 200;
  return std::chrono::microseconds(
      threads > omp_get_num_procs() ? 0 : std::clamp(of_each * threads, least, most));
}

thread_local Team* led_team = nullptr;

/// Hints to the processor that this thread spins, so that its sibling hyperthread may proceed.
void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Polls for this long; false if the answer was never true.
template <class Answer>
bool spin_until(std::chrono::nanoseconds time, Answer&& yes) {
  constexpr int between_looks_at_the_clock = 16;
  using Clock = std::chrono::steady_clock;
  if (yes()) return true;
  for (const auto end = Clock::now() + time; Clock::now() < end;)
    for (int i = 0; i < between_looks_at_the_clock; ++i) {
      if (yes()) return true;
      pause();
    }
  return false;
}

}  // namespace

Team::Team(const Executor& executor)
    : executor_(executor),
      spin_(spin_time(executor.threads())),
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
  team_.call(0, {});
}

void Team::run(const Task& task) {
  call(0, task);
  task.work(task.context, 0);
  join(0, task);
}

void Team::serve(int thread) {
  const auto own = static_cast<std::size_t>(thread);
  Seat& seat = seats_[own];
  for (;;) {
    take_call(seat);
    const Task task = seat.task;
    call(own, task);
    if (task.work == nullptr) return;
    task.work(task.context, thread);
    join(own, task);
    // Releases the loop's writes to the thread that sees this state in join_one(). Sequentially
    // consistent because notify_one() then looks for a waiter; likewise in call().
    if (seat.state.exchange(State::idle) == State::awaited) seat.state.notify_one();
  }
}

/// Waits for a call and takes it; afterwards it cannot be taken back.
void Team::take_call(Seat& seat) const {
  const auto take = [&] {
    // Acquires the task and its caller's writes. A load first would fetch the caller's cache line
    // twice.
    State expected = State::called;
    return seat.state.compare_exchange_strong(expected, State::busy, std::memory_order_acquire,
                                              std::memory_order_relaxed);
  };
  while (!spin_until(spin_, take)) {
    State expected = State::idle;
    if (seat.state.compare_exchange_strong(expected, State::asleep, std::memory_order_relaxed))
      seat.state.wait(State::asleep, std::memory_order_relaxed);
  }
}

std::span<Team::Seat> Team::called_by(std::size_t caller, const Task& task) const {
  const std::size_t size = std::min<std::size_t>(size_, task.threads);
  const std::size_t begin = std::min(size, children * caller + 1);
  return {&seats_[0] + begin, std::min(size - begin, children)};
}

void Team::call(std::size_t caller, const Task& task) {
  for (Seat& seat : called_by(caller, task)) {
    seat.task = task;
    if (seat.state.exchange(State::called) == State::asleep) seat.state.notify_one();
  }
}

void Team::join(std::size_t caller, const Task& task) {
  for (Seat& seat : called_by(caller, task)) join_one(seat, task);
}

void Team::join_one(Seat& seat, const Task& task) const {
  const auto is_done = [&] {
    const State now = seat.state.load(std::memory_order_acquire);
    return now == State::idle || now == State::asleep;
  };
  State expected = State::called;
  if (task.turnout == Turnout::whoever_comes &&
      seat.state.compare_exchange_strong(expected, State::idle, std::memory_order_acquire))
    return;
  while (!spin_until(spin_, is_done)) {
    expected = State::busy;
    if (seat.state.compare_exchange_strong(expected, State::awaited, std::memory_order_relaxed)) {
      seat.state.wait(State::awaited, std::memory_order_relaxed);
    } else {
      std::this_thread::yield();  // it has not begun, or has just finished
    }
  }
}

void run_with_team(const Executor& executor, TeamBody body, void* context) {
  if (executor.threads() == 1 || led_team != nullptr || inside_a_loop()) return body(context);
  Team team(executor);
  FirstError error;
  const auto come = [&](int thread, int size) {
    const detail::ScopedBinding binding(executor.places(), thread);
    if (thread != 0) return team.serve(thread);
    const Team::Leading leading(team, size);
    try {
      body(context);
    } catch (...) {
      error.keep_current();
    }
  };
  const int threads = threads_to_be_had(executor.threads());
  if (!takes_a_region(threads)) {
    come(0, 1);
  } else {
#pragma omp parallel num_threads(threads)
    come(omp_get_thread_num(), omp_get_num_threads());
  }
  error.rethrow();
}

}  // namespace ductile::runtime
