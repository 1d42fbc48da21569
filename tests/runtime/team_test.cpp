#include "ductile/runtime/executor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ductile/runtime/colouring/balance.hpp"
#include "ductile/runtime/colouring/colouring.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "team.hpp"

namespace ductile::runtime::team_test {
namespace {

using namespace std::chrono_literals;

constexpr Schedule schedules[] = {Schedule::automatic,       Schedule::omp_static,
                                  Schedule::omp_dynamic,     Schedule::omp_guided,
                                  Schedule::steal_by_signal, Schedule::steal_by_atomics};

void spin(std::chrono::nanoseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
  }
}

/// Adds 1 to each number; false if one was not reached, or more than once.
bool counts_each_once(const Executor& executor, std::size_t n) {
  std::vector<int> count(n, 0);
  parallel_for(executor, n, [&](std::size_t i) { ++count[i]; }, {.grain = 1});
  return std::accumulate(count.begin(), count.end(), std::size_t{0}) == n &&
         std::all_of(count.begin(), count.end(), [](int c) { return c == 1; });
}

/// Trees of one, two and three levels.
TEST(WithTeam, RunsEachIterationOnceUnderAllSchedules) {
  for (const Schedule schedule : schedules)
    for (const int threads : {1, 2, 3, 5, 6, 8, 22}) {
      const Executor executor({.threads = threads, .schedule = schedule});
      int calls = 0;
      with_team(executor, [&] {
        ++calls;
        for (const std::size_t n : {0, 1, 2, 7, 100, 3000})
          EXPECT_TRUE(counts_each_once(executor, n))
              << static_cast<int>(schedule) << ", threads " << threads << ", n " << n;
      });
      EXPECT_EQ(calls, 1);
    }
}

TEST(WithTeam, RunsFewChunksOnAsManyThreadsAtMost) {
  const Executor executor({.threads = 8});
  std::atomic<int> last_thread = 0;
  with_team(executor, [&] {
    for (int repetition = 0; repetition < 200; ++repetition)
      parallel_for(executor, 3,
                   [&](std::size_t) {
                     spin(2us);
                     if (this_thread() > last_thread) last_thread = this_thread();
                   },
                   {.grain = 1});
  });
  EXPECT_LT(last_thread, 3);
}

/// Covers threads that sleep, are late or have no core: long pauses between loops, threads that
/// finish long before the leader, and leaders that finish before others have begun.
TEST(WithTeam, GoesOnWhereverThreadsAre) {
  const std::chrono::microseconds pauses[] = {0us, 3us, 60us, 300us};
  for (const int threads : {2, 3, 8}) {
    const Executor executor({.threads = threads});
    with_team(executor, [&] {
      for (std::uint64_t round = 0; round < 400; ++round) {
        const std::uint64_t dice = mix64(round);
        spin(pauses[dice % 4]);
        std::atomic<std::size_t> done{0};
        const auto slow = static_cast<std::size_t>(dice >> 8U) % 4;
        parallel_for(executor, 4,
                     [&](std::size_t i) {
                       if (i == slow) spin(pauses[dice / 4 % 4]);
                       ++done;
                     },
                     {.grain = 1});
        ASSERT_EQ(done, 4U);
      }
    });
  }
}

TEST(WithTeam, ShowsLoopsWhatWasWrittenBetweenThem) {
  const Executor executor({.threads = 3});
  std::vector<std::uint64_t> value(64, 0);
  std::uint64_t step = 0;
  with_team(executor, [&] {
    for (step = 1; step <= 2000; ++step) {
      parallel_for(executor, value.size(), [&](std::size_t i) { value[i] += step; }, {.grain = 1});
      ASSERT_EQ(value[step % value.size()], step * (step + 1) / 2);
    }
  });
}

TEST(WithTeam, BringsErrorsOfTheBodyAndOfLoopsToTheCaller) {
  const Executor executor({.threads = 4});
  const auto thrown = [&](auto&& body) {
    try {
      with_team(executor, body);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(thrown([] { throw std::runtime_error("body"); }), "body");
  EXPECT_EQ(thrown([&] {
              parallel_for(executor, 1000,
                           [](std::size_t i) {
                             if (i == 7) throw std::runtime_error("loop");
                           },
                           {.grain = 1});
            }),
            "loop");
  EXPECT_EQ(thrown([&] { EXPECT_TRUE(counts_each_once(executor, 100)); }), "nothing");
}

TEST(WithTeam, LoopsOfOtherExecutorsAndOfACopyRunMeanwhile) {
  const Executor two({.threads = 2}), five({.threads = 5}), copy = two;
  with_team(two, [&] {
    EXPECT_TRUE(counts_each_once(five, 1000));
    EXPECT_TRUE(counts_each_once(copy, 1000));
    with_team(five, [&] { EXPECT_TRUE(counts_each_once(five, 1000)); });
    EXPECT_TRUE(counts_each_once(two, 1000));
  });
}

TEST(WithTeam, InsideALoopCallsTheBodyAndNoMore) {
  const Executor executor({.threads = 4});
  std::atomic<int> calls{0};
  parallel_for(executor, 8,
               [&](std::size_t) {
                 with_team(executor, [&] { calls += counts_each_once(executor, 100) ? 1 : 0; });
               },
               {.grain = 1});
  EXPECT_EQ(calls, 8);
}

TEST(WithTeam, SeveralThreadsHaveTheirOwn) {
  const Executor executor({.threads = 3});
  std::vector<std::jthread> callers;
  callers.reserve(3);
  for (int c = 0; c < 3; ++c)
    callers.emplace_back([&] {
      for (int again = 0; again < 20; ++again)
        with_team(executor, [&] {
          for (int loop = 0; loop < 20; ++loop) EXPECT_TRUE(counts_each_once(executor, 200));
        });
    });
}

TEST(WithTeam, NumbersThreadsFromZeroToTheLast) {
  const Executor executor({.threads = 6});
  PerThread<std::size_t> mine(executor);
  with_team(executor, [&] {
    for (int loop = 0; loop < 50; ++loop) {
      EXPECT_EQ(this_thread(), 0);
      parallel_for(executor, 60,
                   [&](std::size_t) {
                     ASSERT_LT(this_thread(), 6);
                     ++mine.mine();
                   },
                   {.grain = 1});
    }
  });
  std::size_t total = 0;
  for (std::size_t t = 0; t < mine.size(); ++t) total += mine[t];
  EXPECT_EQ(total, 3000U);
}

TEST(WithTeam, ReturnsWhatTheBodyReturns) {
  for (const int threads : {1, 2, 5}) {
    const Executor executor({.threads = threads});
    EXPECT_EQ(with_team(executor, [] { return std::string("result"); }), "result");
  }
}

// ---- Algorithms of many loops form a team by themselves ----

/// Is the calling thread in a team of this executor: its leader, or a thread that the leader has
/// called?
bool in_a_team(const Executor& executor, std::thread::id leader) {
  return std::this_thread::get_id() != leader || Team::of(executor) != nullptr;
}

/// A graph that counts its visits outside of a team.
struct Ring {
  const Executor& executor;
  std::size_t size;
  std::atomic<int>& outside;
  std::thread::id leader = std::this_thread::get_id();

  std::size_t vertex_count() const { return size; }
  void for_each_neighbour(std::uint32_t v, auto&& visit) const {
    if (!in_a_team(executor, leader)) ++outside;
    const auto n = static_cast<std::uint32_t>(size);
    visit((v + 1) % n);
    visit((v + n - 1) % n);
  }
};

TEST(WithTeam, ColouringsFormOne) {
  const Executor executor({.threads = 3});
  std::atomic<int> outside = 0;
  const Ring ring{executor, 200000, outside};
  Colouring colouring = colour(executor, ring, ColouringMethod::detect_again);
  balance(executor, ring, colouring);
  std::vector<std::uint32_t> vertices(ring.size / 20);
  std::iota(vertices.begin(), vertices.end(), 0U);
  recolour(executor, ring, vertices, colouring);
  EXPECT_EQ(outside, 0);
  EXPECT_TRUE(is_proper(executor, ring, colouring));
}

/// Runs each item once; counts resource_count() calls outside of a team.
struct Visits {
  using Item = std::uint32_t;
  struct Plan {};

  const Executor& executor;
  std::atomic<int>& outside;
  std::thread::id leader = std::this_thread::get_id();

  bool plan(Item item, Plan&, auto& reach) const { return reach(item); }
  void apply(Item, const Plan&, auto&) {}
  void conflicts(Item, auto&&) const {}
  std::size_t resource_count() const {
    if (!in_a_team(executor, leader)) ++outside;
    return 1000;
  }
};

TEST(WithTeam, RoundsFormOne) {
  const Executor executor({.threads = 3});
  std::atomic<int> outside = 0;
  std::vector<std::uint32_t> items(1000);
  std::iota(items.begin(), items.end(), 0U);
  for (const Strategy strategy :
       {Strategy::reservations, Strategy::tiles, Strategy::colours, Strategy::in_order}) {
    Visits visits{executor, outside};
    EXPECT_EQ(run_rounds(executor, visits, items, {.strategy = strategy}).applied, 1000U);
  }
  EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace ductile::runtime::team_test
