#include "ductile/runtime/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "spin.hpp"

namespace ductile::runtime::parallel_for_test {
namespace {

using test::spin;

constexpr Schedule schedules[] = {Schedule::automatic,       Schedule::omp_static,
                                  Schedule::omp_dynamic,     Schedule::omp_guided,
                                  Schedule::steal_by_signal, Schedule::steal_by_atomics};
constexpr int thread_counts[] = {1, 2, 3, 4, 8};

std::string described(Schedule schedule, int threads) {
  return "schedule " + std::to_string(static_cast<int>(schedule)) + ", threads " +
         std::to_string(threads);
}

/// Small bodies may be copied, except those that the caller shares or changes and those that cannot
/// be copied.
TEST(ParallelForBody, KeepsItsState) {
  struct Counter {
    std::size_t calls = 0;
    void operator()(std::size_t) { ++calls; }
  };
  struct ConstCounter {
    mutable std::size_t calls = 0;
    void operator()(std::size_t) const { ++calls; }
  };
  const Executor executor({.threads = 1});
  Counter counter;
  parallel_for(executor, 1000, counter);
  EXPECT_EQ(counter.calls, 1000);
  const ConstCounter const_counter;
  parallel_for(executor, 1000, const_counter);
  EXPECT_EQ(const_counter.calls, 1000);

  std::size_t last = 0;
  parallel_for(executor, 1000,
               [&last, calls = std::size_t{0}](std::size_t) mutable { last = ++calls; });
  EXPECT_EQ(last, 1000);
  std::size_t sum = 0;
  parallel_for(executor, 1000,
               [&sum, one = std::make_unique<std::size_t>(1)](std::size_t) { sum += *one; });
  EXPECT_EQ(sum, 1000);
}

class ParallelFor : public testing::TestWithParam<Schedule> {};
INSTANTIATE_TEST_SUITE_P(Schedules, ParallelFor, testing::ValuesIn(schedules));

TEST_P(ParallelFor, VisitsEachIterationOnce) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    for (std::size_t n : {0, 1, 2, 7, 100, 10007})
      for (std::size_t grain : {0, 1, 3, 1000}) {
        std::vector<int> visits(n, 0);
        parallel_for(executor, n, [&](std::size_t i) { ++visits[i]; }, {.grain = grain});
        EXPECT_EQ(visits, std::vector<int>(n, 1)) << described(GetParam(), threads);
      }
  }
}

TEST_P(ParallelFor, VisitsEachIterationOnceWhenLoadIsUneven) {
  for (int threads : {2, 4}) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    for (int round = 0; round < 10; ++round) {
      std::vector<int> visits(2000, 0);
      parallel_for(executor, visits.size(),
                   [&](std::size_t i) {
                     ++visits[i];
                     if (i < 100) spin(std::chrono::microseconds(20));
                   },
                   {.grain = 1});
      EXPECT_EQ(visits, std::vector<int>(2000, 1)) << described(GetParam(), threads);
    }
  }
}

TEST_P(ParallelFor, NumbersItsThreads) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    PerThread<std::size_t> count(executor);
    EXPECT_EQ(count.size(), static_cast<std::size_t>(threads));
    parallel_for(executor, 5000, [&](std::size_t) { ++count.mine(); }, {.grain = 5});
    std::size_t sum = 0;
    for (std::size_t t = 0; t < count.size(); ++t) sum += count[t];
    EXPECT_EQ(sum, 5000U);
    EXPECT_EQ(this_thread(), 0);
  }
}

TEST_P(ParallelFor, PassesOnAnExceptionAndStopsSoon) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    for (std::size_t bad : {0U, 4999U, 9999U}) {
      EXPECT_THROW(parallel_for(executor, 10000,
                                [&](std::size_t i) {
                                  if (i == bad) throw std::runtime_error("bad");
                                }),
                   std::runtime_error)
          << described(GetParam(), threads);
    }
    std::atomic<int> ran{0};
    EXPECT_THROW(parallel_for(executor, 1000000,
                              [&](std::size_t) {
                                ++ran;
                                spin(std::chrono::microseconds(1));
                                throw std::runtime_error("all bad");
                              },
                              {.grain = 1}),
                 std::runtime_error);
    EXPECT_LE(ran, threads) << described(GetParam(), threads);
    EXPECT_EQ(this_thread(), 0);
  }
}

TEST_P(ParallelFor, RunsLoopsInsideOnTheCallingThread) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    const Executor single({.threads = 1});
    std::atomic<std::size_t> sum{0};
    parallel_for(executor, 200,
                 [&](std::size_t) {
                   const int outer = this_thread();
                   const auto self = std::this_thread::get_id();
                   std::size_t count = 0;  // no race, as only this thread touches it
                   parallel_for(executor, 1000, [&](std::size_t) {
                     ++count;
                     EXPECT_EQ(this_thread(), outer);
                     EXPECT_EQ(std::this_thread::get_id(), self);
                   });
                   PerThread<int> one(single);
                   parallel_for(single, 3, [&](std::size_t) { ++one.mine(); });
                   EXPECT_EQ(one[0], 3);
                   EXPECT_EQ(this_thread(), outer);
                   sum += count;
                 },
                 {.grain = 1});
    EXPECT_EQ(sum, 200U * 1000U);
  }
}

TEST_P(ParallelFor, ServesSeveralCallersAtOnce) {
  std::vector<std::thread> callers;
  callers.reserve(4);
  std::atomic<int> good{0};
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&, caller] {
      const Executor executor({.threads = 2 + caller % 2, .schedule = GetParam()});
      for (int round = 0; round < 10; ++round) {
        std::vector<std::uint32_t> values(3000);
        parallel_for(executor, values.size(),
                     [&](std::size_t i) { values[i] = mix32(static_cast<std::uint32_t>(i)); });
        bool right = true;
        for (std::uint32_t i = 0; i < values.size(); ++i) right = right && values[i] == mix32(i);
        good += right;
      }
    });
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(good, 40);
}

TEST_P(ParallelFor, LendsEachThreadItsOwn) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads, .schedule = GetParam()});
    PerThread<std::size_t> sums(executor), counts(executor);
    parallel_for(executor, 10007, with(sums, counts),
                 [](std::size_t i, std::size_t& sum, std::size_t& count) { sum += i, ++count; });
    std::size_t sum = 0, count = 0;
    for (std::size_t t = 0; t < sums.size(); ++t) sum += sums[t], count += counts[t];
    EXPECT_EQ(sum, 10006U * 10007U / 2) << described(GetParam(), threads);
    EXPECT_EQ(count, 10007U);
  }
}

TEST(ParallelForBlocks, CutsTheSameBlocksAtAnyThreadCount) {
  for (int threads : thread_counts) {
    std::vector<std::pair<std::size_t, std::size_t>> bounds(11);
    parallel_for_blocks(Executor({.threads = threads}), 1003, 100,
                        [&](std::size_t b, std::size_t begin, std::size_t end) {
                          bounds[b] = {begin, end};
                        });
    for (std::size_t b = 0; b < 11; ++b)
      EXPECT_EQ(bounds[b], std::pair(b * 100, std::min<std::size_t>(1003, b * 100 + 100)));
  }
}

TEST(ParallelReduce, GivesTheSameBitsAtAnyThreadCount) {
  const auto value = [](std::size_t i) { return std::sin(static_cast<double>(i)) * 1e-3; };
  const auto sum = [&](int threads) {
    return parallel_reduce(Executor({.threads = threads}), 100003, 0.0, value, std::plus<>());
  };
  const double first = sum(1);
  for (int threads : thread_counts) EXPECT_EQ(sum(threads), first);
  EXPECT_EQ(parallel_reduce(Executor({.threads = 2}), 0, 5, value, std::plus<>()), 5);
}

TEST(ExclusiveScan, AddsWhatComesBefore) {
  for (int threads : thread_counts)
    for (std::size_t n : {0, 1, 4096, 50001}) {
      std::vector<std::uint64_t> values(n), expected(n);
      for (std::size_t i = 0; i < n; ++i) values[i] = mix64(i) >> 32U;
      std::exclusive_scan(values.begin(), values.end(), expected.begin(), std::uint64_t{0});
      const std::uint64_t total = std::accumulate(values.begin(), values.end(), std::uint64_t{0});
      EXPECT_EQ(exclusive_scan(Executor({.threads = threads}), std::span(values)), total);
      EXPECT_EQ(values, expected);
    }
}

TEST(ParallelForBlocks, TakesBlocksLongerThanTheLoop) {
  std::size_t sum = 0;
  parallel_for_blocks(Executor({.threads = 2}), 10, ~std::size_t{0},
                      [&](std::size_t, std::size_t begin, std::size_t end) { sum += end - begin; });
  EXPECT_EQ(sum, 10U);
}

TEST(ParallelForNested, RunsInsideAShortLoopOnTheCallingThread) {
  const Executor executor({.threads = 4}), single({.threads = 1});
  const auto expect_alone = [&](std::size_t) {
    const auto self = std::this_thread::get_id();
    parallel_for(executor, 10000, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), self); },
                 {.grain = 1});
  };
  parallel_for(executor, 1, expect_alone);
  parallel_for(executor, 3, expect_alone, {.serial_below = 4});
  parallel_for(single, 3, expect_alone);
}

TEST(ParallelReduce, TellsWhetherAll) {
  for (int threads : thread_counts) {
    const Executor executor({.threads = threads});
    for (const std::size_t odd_one : {0U, 70000U, 99999U, 100000U})
      EXPECT_EQ(parallel_reduce(
                    executor, 100000, true, [&](std::size_t i) { return i != odd_one; },
                    std::logical_and<>()),
                odd_one == 100000);
  }
}

}  // namespace
}  // namespace ductile::runtime::parallel_for_test
