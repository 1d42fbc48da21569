/// @file
/// Work stealing: late threads are helped; handling of signals.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "spin.hpp"

namespace ductile::runtime::stealing_test {
namespace {

using test::spin;

std::string described(Schedule schedule, int threads) {
  return "schedule " + std::to_string(static_cast<int>(schedule)) + ", threads " +
         std::to_string(threads);
}

TEST(StealBySignal, GivesItsSignalBackAndLeavesHandlersOfOthersAlone) {
  static std::atomic<int> heard;
  heard = 0;
  std::vector<struct sigaction> before;
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number) {
    struct sigaction mine = {}, old = {};
    mine.sa_handler = [](int) { ++heard; };
    sigaction(number, &mine, &old);
    before.push_back(old);
  }
  // All numbers are taken, so one is shared while the loop runs.
  const Executor executor({.threads = 2, .schedule = Schedule::steal_by_signal});
  std::atomic<int> sum{0};
  const int sender = SIGRTMAX;
  parallel_for(executor, 200,
               [&](std::size_t i) {
                 ++sum;
                 if (i % 50 == 0) raise(sender);
                 spin(std::chrono::microseconds(i < 100 ? 50 : 1));
               },
               {.grain = 1});
  EXPECT_EQ(sum, 200);
  EXPECT_EQ(heard, 4);
  raise(sender);
  EXPECT_EQ(heard, 5);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number)
    sigaction(number, &before[static_cast<std::size_t>(number - SIGRTMIN)], nullptr);
}

TEST(StealBySignal, EndsWhereTheCallerBlocksAllSignals) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::atomic<int> sum{0};
  parallel_for(Executor({.threads = 2}), 400,
               [&](std::size_t i) {
                 ++sum;
                 spin(std::chrono::microseconds(i < 200 ? 20 : 1));
               },
               {.grain = 1, .schedule = Schedule::steal_by_signal});
  EXPECT_EQ(sum, 400);
  sigset_t after;
  pthread_sigmask(SIG_SETMASK, &before, &after);
  EXPECT_EQ(sigismember(&after, SIGRTMAX), 1);
}

/// Signals that the calling thread blocks until destruction.
class Blocked {
 public:
  explicit Blocked(const sigset_t& blocked) { pthread_sigmask(SIG_SETMASK, &blocked, &before_); }
  ~Blocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  Blocked(const Blocked&) = delete;
  Blocked& operator=(const Blocked&) = delete;

 private:
  sigset_t before_{};
};

TEST(StealBySignal, LeavesSignalsAloneThatTheCallerWaitsFor) {
  sigset_t waited_for;
  sigemptyset(&waited_for);
  for (int number = SIGRTMIN; number <= SIGRTMAX; ++number)
    if (number != SIGRTMIN + 2) sigaddset(&waited_for, number);
  const Blocked blocked(waited_for);
  const auto send_all = [] {
    for (int number = SIGRTMIN; number <= SIGRTMAX; ++number)
      if (number != SIGRTMIN + 2) raise(number);  // to this thread
  };
  send_all();
  parallel_for(Executor({.threads = 2}), 400,
               [&](std::size_t i) {
                 if (i == 0) send_all();
                 spin(std::chrono::microseconds(i < 200 ? 20 : 1));
               },
               {.grain = 1, .schedule = Schedule::steal_by_signal});
  const timespec at_once{};
  int found = 0;
  while (sigtimedwait(&waited_for, nullptr, &at_once) > 0) ++found;
  EXPECT_EQ(found, 2 * (SIGRTMAX - SIGRTMIN));
}

// ---- Stealing: a loop that only ends if threads are helped ----

/// Runs a loop in which iteration `slow` waits until all others, except `but_for` of them, are
/// done. Returns false if it has waited too long.
bool others_are_done_meanwhile(const Executor& executor, std::size_t n, std::size_t slow,
                               std::size_t but_for) {
  using namespace std::chrono_literals;
  std::atomic<std::size_t> done = 0;
  bool in_time = true;
  parallel_for(executor, n,
               [&](std::size_t i) {
                 if (i != slow) return void(++done);
                 const auto end = std::chrono::steady_clock::now() + 20s;
                 while (done < n - 1 - but_for && in_time) {
                   std::this_thread::yield();
                   in_time = std::chrono::steady_clock::now() < end;
                 }
               },
               {.grain = 1});
  return in_time;
}

class Stealing : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, Stealing,
                         testing::Values(Schedule::steal_by_signal, Schedule::steal_by_atomics));

TEST_P(Stealing, TakesWhatAThreadDoesNotGetTo) {
  constexpr std::size_t n = 120;  // few enough to be claimed one by one
  // A victim's handler does not give away the iteration that the victim may be about to begin.
  const std::size_t kept = GetParam() == Schedule::steal_by_signal ? 1 : 0;
  for (const int threads : {2, 3, 8}) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    const auto parts = static_cast<std::size_t>(threads);
    for (std::size_t slow = 0; slow < parts; ++slow)
      ASSERT_TRUE(others_are_done_meanwhile(executor, n, n * slow / parts, kept))
          << described(GetParam(), threads) << ", slow part " << slow;
  }
}

TEST(StealBySignal, ReachesThreadsThatBlockAllSignals) {
  // Threads inherit the mask of their creator, and OpenMP keeps them for its next loop.
  std::thread([] {
    const Executor executor({.threads = 2, .schedule = Schedule::steal_by_signal});
    {
      sigset_t all;
      sigfillset(&all);
      const Blocked blocked(all);
      parallel_for(executor, 100, [](std::size_t) {}, {.grain = 1});
    }
    EXPECT_TRUE(others_are_done_meanwhile(executor, 100, 50, 1));
  }).join();
}

/// A few iterations are long, so that victims seem to have more left than they have: many signals
/// arrive when there is too little to give.
TEST(StealBySignal, RunsNothingTwiceThatWasRefused) {
  for (std::uint32_t loop = 0; loop < 1000; ++loop) {
    std::vector<std::atomic<int>> runs(90);
    parallel_for(Executor({.threads = 3}), runs.size(),
                 [&](std::size_t i) {
                   ++runs[i];
                   const bool is_long = mix32(1000 * loop + static_cast<std::uint32_t>(i)) % 8 == 0;
                   spin(std::chrono::nanoseconds(is_long ? 40000 : 500));
                 },
                 {.grain = 1, .schedule = Schedule::steal_by_signal});
    for (const auto& count : runs) ASSERT_EQ(count, 1) << loop;
  }
}

}  // namespace
}  // namespace ductile::runtime::stealing_test
