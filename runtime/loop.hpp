/// @file
/// Shared by the schedulers (private to the runtime): the current loop, the team of threads that
/// runs it, and the first exception thrown in it.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <utility>

#include "binding.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "team.hpp"
#include "threads_to_be_had.hpp"

namespace ductile::runtime {

/// The first exception of a loop. Thread safety: any thread; rethrow() after the join.
class FirstError {
 public:
  void keep_current() noexcept {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
    // Relaxed: says only that work may stop; the join orders error_.
    thrown_.store(true, std::memory_order_relaxed);
  }
  bool thrown() const noexcept { return thrown_.load(std::memory_order_relaxed); }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> thrown_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

/// One call of run_loop: n iterations handed out in chunks of `grain`.
struct Loop {
  RangeBody body;
  void* context;
  std::size_t n;
  std::size_t grain;
  FirstError error = {};

  std::size_t chunk_count() const { return n / grain + (n % grain != 0); }

  /// Runs the body over [begin, end); false if the loop is to stop. Thread safety: any thread.
  bool run(std::size_t begin, std::size_t end) noexcept {
    if (error.thrown()) return false;
    detail::loop_place.begin = begin, detail::loop_place.end = end;
    try {
      body(context, begin, end);
    } catch (...) {
      error.keep_current();
    }
    return true;
  }
};

/// Puts the calling thread into a loop during its lifetime: nested loops run on it alone.
class TeamMember {
 public:
  explicit TeamMember(const detail::LoopPlace& place) noexcept
      : before_(std::exchange(detail::loop_place, place)) {}
  ~TeamMember() { detail::loop_place = before_; }
  TeamMember(const TeamMember&) = delete;
  TeamMember& operator=(const TeamMember&) = delete;

 private:
  detail::LoopPlace before_;
};

/// Does the calling thread run iterations of a loop?
inline bool inside_a_loop() noexcept { return detail::loop_place.threads != 0; }

inline std::size_t everyone_of(const Executor& executor) {
  return static_cast<std::size_t>(executor.threads());
}

/// Calls work(thread) on the first `wanted` threads of the caller's team; without one, of an OpenMP
/// team of at most executor.threads() threads; or alone (threads_to_be_had.hpp). The team's size
/// does not follow the loop's, because OpenMP runtimes end and create threads when it changes.
template <class Work>
void run_team(const Executor& executor, Turnout turnout, std::size_t wanted, Work&& work) {
  auto as_member = [&, loop = detail::loop_place.loop](int thread) {
    const TeamMember member({thread, executor.threads(), loop});
    work(thread);
  };
  if (Team* const team = Team::of(executor)) {
    using Member = decltype(as_member);
    return team->run({[](void* context, int thread) { (*static_cast<Member*>(context))(thread); },
                      &as_member, turnout, static_cast<std::uint32_t>(wanted)});
  }
  const auto come = [&](int thread) {
    const detail::ScopedBinding binding(executor.places(), thread);
    if (static_cast<std::size_t>(thread) < wanted) as_member(thread);
  };
  const int threads = threads_to_be_had(executor.threads());
  if (!takes_a_region(threads)) return come(0);
#pragma omp parallel num_threads(threads)
  come(omp_get_thread_num());
}

void run_omp_static(const Executor& executor, Loop& loop);
void run_omp_dynamic(const Executor& executor, Loop& loop);
void run_omp_guided(const Executor& executor, Loop& loop);
void run_steal_by_atomics(const Executor& executor, Loop& loop);
/// Steals by atomics instead if no signal is available.
void run_steal_by_signal(const Executor& executor, Loop& loop);

}  // namespace ductile::runtime
