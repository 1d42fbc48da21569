/// @file
/// Work stealing by signal, after the interrupt-driven scheduler of Rokos, Gorman and Kelly (arXiv
/// 1505.04134). A thread works through its own part without synchronisation. A thread without work
/// sends a real-time signal to the one with most work left; the handler, on the victim's own
/// thread, gives away the back half of the rest.
/// Victim and handler are the same thread, so they need no atomic read-modify-write: the handler
/// leaves alone the first `grain` iterations, which the victim may be about to claim. A signal
/// costs some microseconds, so none is sent for less work. A thief waits for the answer before it
/// does anything else, so no signal is pending when the loop ends.

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "loop.hpp"
#include "steal_signal.hpp"

// ThreadSanitizer holds signals back until a thread makes a system call, which may never happen.
#if defined(__SANITIZE_THREAD__)
#define DUCTILE_SIGNALS_ARRIVE 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define DUCTILE_SIGNALS_ARRIVE 0
#endif
#endif
#ifndef DUCTILE_SIGNALS_ARRIVE
#define DUCTILE_SIGNALS_ARRIVE 1
#endif

namespace ductile::runtime {

namespace {

constexpr std::int64_t worth_a_signal_ns = 20000;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// One thread's part of the loop. Only its own thread and handler write it, except `thief` and the
/// answer, which the victim's handler writes. Others read the part to estimate the rest. All
/// members are lock-free, so handlers may access them.
struct alignas(128) Part {
  enum Answer : int { pending, given, refused };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  // ---- Work of this thread: [begin, end), started at `first` at `since_ns` ----
  std::atomic<std::uint64_t> begin{0}, end{0}, first{0};
  std::atomic<std::int64_t> since_ns{0};
  std::uint64_t grain = 1;
  pthread_t self{};
  std::atomic<bool> ready{false};

  // ---- Asked of this thread ----
  alignas(128) std::atomic<Part*> thief{nullptr};

  // ---- Asked by this thread ----
  alignas(128) std::atomic<int> answer{pending};
  std::uint64_t given_begin = 0, given_end = 0;

  void start(std::uint64_t from, std::uint64_t to) {
    // The part is empty while it changes. A signal fence keeps the order of the stores for the
    // handler; other threads only guess, so relaxed is enough.
    end.store(0, std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    first.store(from, std::memory_order_relaxed);
    since_ns.store(now_ns(), std::memory_order_relaxed);
    begin.store(from, std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    end.store(to, std::memory_order_relaxed);
  }

  std::uint64_t left() const {
    const std::uint64_t from = begin.load(std::memory_order_relaxed);
    const std::uint64_t to = end.load(std::memory_order_relaxed);
    return from < to ? to - from : 0;
  }

  /// An estimate from the pace so far.
  std::int64_t ns_left(std::int64_t now) const {
    const std::uint64_t from = begin.load(std::memory_order_relaxed);
    const std::uint64_t done = from - std::min(from, first.load(std::memory_order_relaxed));
    const auto spent = static_cast<double>(now - since_ns.load(std::memory_order_relaxed));
    return static_cast<std::int64_t>(static_cast<double>(left()) * spent /
                                     static_cast<double>(done + 1));
  }
};

/// Runs in the victim's handler: gives the back half to the thief that asked.
void give_half(void* sent) {
  Part& victim = *static_cast<Part*>(sent);
  // Acquire pairs with the release in ask().
  Part* const thief = victim.thief.load(std::memory_order_acquire);
  const std::uint64_t begin = victim.begin.load(std::memory_order_relaxed);
  const std::uint64_t end = victim.end.load(std::memory_order_relaxed);
  int answer = Part::refused;
  if (begin < end && end - begin >= 2 * victim.grain) {
    const std::uint64_t middle = begin + (end - begin + 1) / 2;  // at least grain from begin
    victim.end.store(middle, std::memory_order_relaxed);
    thief->given_begin = middle;
    thief->given_end = end;
    answer = Part::given;
  }
  victim.thief.store(nullptr, std::memory_order_relaxed);
  // Release pairs with the acquire in ask(): the thief sees what it was given, and that the victim
  // may be asked again.
  thief->answer.store(answer, std::memory_order_release);
}

class SignalLoop {
 public:
  SignalLoop(const StealSignal& signal, Loop& loop, std::span<Part> parts)
      : signal_(signal), loop_(loop), parts_(parts) {}

  /// Called on each thread of the team.
  void run(std::size_t thread, std::size_t team_size) {
    const StealSignal::Reception reception(signal_);
    Part& mine = parts_[thread];
    mine.self = pthread_self();
    mine.grain = loop_.grain;
    mine.start(loop_.n * thread / team_size, loop_.n * (thread + 1) / team_size);
    mine.ready.store(true, std::memory_order_release);  // pairs with the acquire in ask()
    do walk(mine);
    while (!loop_.error.thrown() && find_work(mine, team_size));
#pragma omp barrier  // nobody asks any more; only now the signal may be blocked again
  }

 private:
  /// Runs the part from its front, in chunks, until it is used up.
  void walk(Part& mine) {
    for (;;) {
      const std::uint64_t from = mine.begin.load(std::memory_order_relaxed);
      const std::uint64_t end = mine.end.load(std::memory_order_relaxed);
      if (from >= end) return;
      const std::uint64_t to = std::min(from + loop_.grain, end);
      // If the handler comes before this store, it leaves [from, to) here.
      mine.begin.store(to, std::memory_order_relaxed);
      std::atomic_signal_fence(std::memory_order_seq_cst);
      if (!loop_.run(from, to)) return mine.start(0, 0);
    }
  }

  /// Waits until there is work to take, or none left worth taking.
  bool find_work(Part& mine, std::size_t team_size) {
    for (unsigned tries = 0;; ++tries) {
      const std::int64_t now = now_ns();
      Part* victim = nullptr;
      std::int64_t most = 0;
      bool some_left = false;
      for (Part& part : parts_.first(team_size)) {
        if (!part.ready.load(std::memory_order_relaxed)) some_left = true;  // it will have work
        if (part.left() < 2 * loop_.grain) continue;
        some_left = true;
        const std::int64_t left = part.ns_left(now);
        if (left > most) victim = &part, most = left;
      }
      if (!some_left || loop_.error.thrown()) return false;
      if (most >= worth_a_signal_ns && ask(*victim, mine)) return true;
      std::this_thread::yield();
    }
  }

  /// Asks the victim for half of its work; true if `mine` got some.
  bool ask(Part& victim, Part& mine) {
    if (!victim.ready.load(std::memory_order_acquire)) return false;
    mine.answer.store(Part::pending, std::memory_order_relaxed);
    Part* nobody = nullptr;
    if (!victim.thief.compare_exchange_strong(nobody, &mine, std::memory_order_acq_rel))
      return false;  // somebody else is asking
    if (!signal_.send(victim.self, &victim)) {
      victim.thief.store(nullptr, std::memory_order_relaxed);
      return false;
    }
    int answer = Part::pending;
    for (unsigned spins = 0; answer == Part::pending; ++spins) {
      if (spins > 1000) std::this_thread::yield();
      answer = mine.answer.load(std::memory_order_acquire);
    }
    if (answer == Part::refused) return false;
    mine.start(mine.given_begin, mine.given_end);
    return true;
  }

  const StealSignal& signal_;
  Loop& loop_;
  std::span<Part> parts_;
};

}  // namespace

void run_steal_by_signal(const Executor& executor, Loop& loop) {
  const StealSignal signal(give_half);
  if (!DUCTILE_SIGNALS_ARRIVE || !signal.available()) return run_steal_by_atomics(executor, loop);
  std::vector<Part> parts(static_cast<std::size_t>(executor.threads()));
  SignalLoop signal_loop(signal, loop, parts);
  run_team(executor, Turnout::everyone, everyone_of(executor), [&](int thread) {
    signal_loop.run(static_cast<std::size_t>(thread),
                    static_cast<std::size_t>(omp_get_num_threads()));
  });
}

}  // namespace ductile::runtime
