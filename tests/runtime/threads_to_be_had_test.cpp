/// @file
/// Loops in a forked child, and in a process that gets no more threads, run completely on the
/// calling thread.
#include "threads_to_be_had.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::threads_to_be_had_test {
namespace {

constexpr Schedule schedules[] = {Schedule::omp_static, Schedule::omp_dynamic, Schedule::omp_guided,
                                  Schedule::steal_by_signal, Schedule::steal_by_atomics};

bool counts_each_once(const Executor& executor) {
  std::vector<int> count(2000, 0);
  parallel_for(executor, count.size(), [&](std::size_t i) { ++count[i]; }, {.grain = 1});
  return std::all_of(count.begin(), count.end(), [](int c) { return c == 1; });
}

/// Do loops work under all schedules, with and without a team?
bool loops_work(int threads) {
  for (const Schedule schedule : schedules) {
    const Executor executor({.threads = threads, .schedule = schedule});
    if (!counts_each_once(executor)) return false;
    if (!with_team(executor, [&] { return counts_each_once(executor); })) return false;
  }
  return true;
}

/// The exit status of a forked child that does this; -1 if it does not end.
int status_of_child(const std::function<bool()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(30);
    ::_exit(work() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ThreadsToBeHad, AreNoneInAChildOfAProcessWithThreads) {
  ASSERT_TRUE(loops_work(4));
  EXPECT_EQ(status_of_child([] { return threads_to_be_had(4) == 1 && loops_work(4); }), 0);
  EXPECT_EQ(status_of_child(
                [] { return status_of_child([] { return loops_work(3); }) == 0 && loops_work(8); }),
            0);
  EXPECT_EQ(threads_to_be_had(4), 4);
  EXPECT_TRUE(loops_work(4));
}

/// Such threads may belong to another user of OpenMP.
TEST(ThreadsToBeHad, AreNoneInAChildOfAProcessWithThreadsOfOthers) {
  std::promise<void> end;
  std::thread other([waits = end.get_future()]() mutable { waits.get(); });
  EXPECT_EQ(status_of_child([] { return threads_to_be_had(3) == 1 && loops_work(3); }), 0);
  end.set_value();
  other.join();
}

/// Limits addresses, which stacks need, because root may start any number of threads.
void limit_addresses_to_what_is_there() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  constexpr rlim_t more = rlim_t{4} << 20U;  // less than a stack
  const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more;
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

bool are_addresses_counted() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#elif defined(__has_feature)
  return !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
  return true;
#endif
}

TEST(ThreadsToBeHad, AreNoneWhereTheyCannotBeMade) {
  if (!are_addresses_counted()) GTEST_SKIP() << "sanitizers reserve all addresses";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto limited = [] {
    limit_addresses_to_what_is_there();
    std::_Exit(threads_to_be_had(8) == 1 && loops_work(8) && loops_work(3) ? 0 : 1);
  };
  EXPECT_EXIT(limited(), testing::ExitedWithCode(0), "");
}

TEST(ThreadsToBeHad, AreAllWantedOtherwise) {
  for (const int wanted : {1, 2, 7, 3, 16}) EXPECT_EQ(threads_to_be_had(wanted), wanted);
  EXPECT_TRUE(loops_work(16));
}

}  // namespace
}  // namespace ductile::runtime::threads_to_be_had_test
