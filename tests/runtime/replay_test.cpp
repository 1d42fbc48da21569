#include "ductile/runtime/replay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <numeric>
#include <optional>
#include <thread>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/run_rounds.hpp"

namespace ductile::runtime::replay_test {
namespace {

constexpr double second = 1e9;  // nanoseconds, exact as float below 2^24 of them times a power of 2

/// A loop of single items with these costs.
void record_items(Recording& recording, const std::vector<double>& costs) {
  recording.begin_loop();
  for (const double cost : costs) recording.end_item(cost);
  recording.end_chunk();
  recording.end_loop();
}

TEST(Replay, SharesEqualItemsEqually) {
  Recording recording;
  record_items(recording, std::vector<double>(800, second));
  const auto elapsed = [&](int threads, std::size_t block) {
    return replay(recording, {.threads = threads, .launch_ns = 0, .block = block}).total.elapsed;
  };
  EXPECT_NEAR(elapsed(1, 1), 800, 0.1);
  EXPECT_NEAR(elapsed(8, 1), 100, 0.1);
  EXPECT_NEAR(elapsed(8, 100), 100, 0.1);
  EXPECT_NEAR(elapsed(64, 100), 100, 0.1);  // eight blocks keep no more than eight threads busy
  EXPECT_NEAR(elapsed(3, 400), 400, 0.1);
  EXPECT_NEAR(elapsed(1000, 1), 1, 0.1);
}

TEST(Replay, CountsLaunchesOfLoopsThatAreShared) {
  Recording recording;
  for (int loop = 0; loop < 3; ++loop) record_items(recording, {second, second});
  record_items(recording, {second});
  const Replay two = replay(recording, {.threads = 2, .launch_ns = 10 * second, .block = 1});
  EXPECT_EQ(two.total.launches, 3U);
  EXPECT_NEAR(two.total.elapsed, 3 * 11 + 1, 0.1);
  EXPECT_NEAR(two.total.critical, 3 * 11 + 1, 0.1);
  EXPECT_NEAR(two.total.work, 7, 0.1);
  EXPECT_NEAR(two.total.balance(2), 7.0 / 34 / 2, 0.01);
  EXPECT_EQ(replay(recording, {.threads = 1}).total.launches, 0U);
}

/// Any greedy schedule is within these bounds (Graham, SIAM J. Appl. Math. 17, 1969).
TEST(Replay, KeepsTheBoundsOfGreedySchedules) {
  std::vector<double> costs(1000);
  for (std::uint32_t i = 0; i < 1000; ++i) costs[i] = second * (1 + mix32(i) % 50);
  Recording recording;
  record_items(recording, costs);
  const double work = std::accumulate(costs.begin(), costs.end(), 0.0) / second;
  double before = 1e9;
  for (const int threads : {1, 2, 3, 8, 64, 500, 5000}) {
    const ReplayTimes times =
        replay(recording, {.threads = threads, .launch_ns = 0, .block = 1}).total;
    EXPECT_NEAR(times.work, work, 0.1);
    EXPECT_NEAR(times.critical, 50, 0.1);
    EXPECT_GE(times.elapsed + 0.1, std::max(work / threads, times.critical));
    EXPECT_LE(times.elapsed - 0.1, work / threads + times.critical);
    EXPECT_LE(times.elapsed, before + 50);
    before = times.elapsed;
  }
}

TEST(Replay, BooksSectionsPhasesAndRounds) {
  Recording recording;
  recording.begin_section("first");
  recording.set_phase(Phase::plan);
  record_items(recording, {second});
  recording.begin_section("second");
  recording.begin_round();
  record_items(recording, {second, second});
  recording.begin_round();
  recording.set_phase(Phase::apply);
  record_items(recording, {second, second, second});
  recording.end_rounds();
  recording.pause();
  record_items(recording, {second, second, second});
  recording.begin_section("first");
  record_items(recording, {4 * second});
  const Replay result = replay(recording, {.threads = 1});
  ASSERT_EQ(result.sections.size(), 3U);
  const auto work = [&](std::size_t section, Phase phase) {
    return result.sections[section].times_of[static_cast<std::size_t>(phase)].work;
  };
  EXPECT_EQ(result.sections[1].name, "first");
  EXPECT_NEAR(work(1, Phase::plan), 1, 0.01);
  EXPECT_NEAR(work(1, Phase::apply), 4, 0.01);
  EXPECT_NEAR(work(2, Phase::plan), 2, 0.01);
  EXPECT_NEAR(work(2, Phase::apply), 3, 0.01);
  ASSERT_EQ(result.rounds.size(), 2U);
  EXPECT_NEAR(result.rounds[0].work, 2, 0.01);
  EXPECT_NEAR(result.rounds[1].work, 3, 0.01);
}

TEST(Replay, RefusesNoThreads) {
  EXPECT_THROW(replay(Recording(), {.threads = 0}), std::invalid_argument);
}

TEST(Replay, HandsItemsOutAsTheLoopDid) {
  Recording recording;
  recording.begin_loop();
  for (int chunk = 0; chunk < 3; ++chunk) {
    for (int item = 0; item < (chunk < 2 ? 4 : 2); ++item) recording.end_item(second);
    recording.end_chunk();
  }
  recording.end_loop();
  const auto elapsed = [&](std::size_t block) {
    return replay(recording, {.threads = 16, .launch_ns = 0, .block = block}).total.elapsed;
  };
  EXPECT_NEAR(elapsed(0), 4, 0.1);
  EXPECT_NEAR(elapsed(1), 1, 0.1);
  EXPECT_NEAR(elapsed(10), 10, 0.1);
}

TEST(Recording, TimesTheChunksOfALoop) {
  Recording recording;
  const Executor executor({.threads = 16, .recording = &recording});
  std::vector<int> runs(1000);
  parallel_for(executor, runs.size(), [&](std::size_t i) { ++runs[i]; }, {.grain = 10});
  EXPECT_EQ(std::count(runs.begin(), runs.end(), 1), 1000);
  const auto& last = recording.stretches().back();
  EXPECT_EQ(last.kind, Recording::Stretch::Kind::chunks);
  EXPECT_EQ(last.count, 100U);
}

/// Three parts of a loop of one chunk, the first of them in two pieces.
void record_parts(Recording& recording, const std::vector<Recording::Wait>& waits) {
  const auto work = [] {
    for (volatile int i = 0; i < 100000;) i = i + 1;
  };
  recording.begin_loop();
  for (const std::size_t part : {0U, 2U, 1U, 0U}) {
    recording.begin_part(part);
    work();
  }
  for (const auto& [part, on] : waits) recording.part_waits(part, on);
  recording.end_chunk();
  recording.end_loop();
}

TEST(Replay, RunsPartsOfALoopSideBySideUnlessTheyWait) {
  const auto expect = [](const std::vector<Recording::Wait>& waits, auto&& expected) {
    Recording recording;
    record_parts(recording, waits);
    const auto& loop = recording.stretches().back();
    ASSERT_EQ(loop.count, 3U);
    const auto cost = [&](std::size_t part) { return 1e-9 * recording.costs()[loop.first + part]; };
    const ReplayTimes times = replay(recording, {.threads = 3, .launch_ns = 0}).total;
    EXPECT_NEAR(times.elapsed - times.serial, expected(cost(0), cost(1), cost(2)), 1e-9);
    EXPECT_NEAR(times.critical, times.elapsed, 1e-9);
    EXPECT_NEAR(times.work, cost(0) + cost(1) + cost(2), 1e-9);
    EXPECT_GT(cost(1), 0);
  };
  expect({}, [](double a, double b, double c) { return std::max({a, b, c}); });
  expect({{2, 1}, {1, 0}}, [](double a, double b, double c) { return a + b + c; });
  expect({{2, 0}, {1, 0}}, [](double a, double b, double c) { return a + std::max(b, c); });
}

TEST(Recording, LeavesOutWhatRunsAside) {
  Recording recording;
  const auto work = [] {
    for (volatile int i = 0; i < 3000000;) i = i + 1;
  };
  const auto begin = std::chrono::steady_clock::now();
  recording.begin_loop();
  recording.aside(work);
  recording.end_chunk();
  recording.end_loop();
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(replay(recording, {.threads = 1}).total.work, 0.5 * all.count());
}

TEST(Recording, KnowsOnlyWaitsForEarlierParts) {
  Recording recording;
  EXPECT_THROW(recording.part_waits(3, 3), std::invalid_argument);
}

/// That this thread has run. Other threads of the process may spin meanwhile.
double thread_seconds() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void run_for(double seconds) {
  for (const double end = thread_seconds() + seconds; thread_seconds() < end;) continue;
}

TEST(Recording, TakesNoCostForTimeInWhichTheThreadDidNotRunBefore) {
  Recording recording;
  recording.begin_loop();
  for (int chunk = 0; chunk < 20; ++chunk) {
    std::this_thread::sleep_for(std::chrono::microseconds(80));
    recording.end_chunk();
  }
  run_for(1e-3);
  recording.end_chunk();
  recording.end_loop();
  EXPECT_GT(recording.costs().back(), 0.8e6);
}

TEST(Recording, LeavesOutTheTimeInWhichTheThreadDoesNotRun) {
  run_for(0.03);  // longer than it will sleep: what it ran before must not count
  Recording recording;
  const Executor executor({.threads = 2, .recording = &recording});
  const auto sleep = [](std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  };
  parallel_for(executor, 4, sleep, {.grain = 1});
  EXPECT_LT(replay(recording, {.threads = 1}).total.work, 0.02);
}

TEST(Recording, TakesTheLeastOfEachCost) {
  Recording first, second_time;
  for (Recording* recording : {&first, &second_time}) recording->begin_section("part");
  record_items(first, {2 * second, 3 * second, 5 * second});
  record_items(second_time, {4 * second, second, 5 * second});
  first.take_least(second_time);
  EXPECT_NEAR(replay(first, {}).total.work, 2 + 1 + 5, 0.1);
}

TEST(Recording, TakesTheLeastOfTheSameRunOnly) {
  Recording all, fewer, elsewhere;
  record_items(all, {second, second});
  record_items(fewer, {second});
  elsewhere.begin_section("elsewhere");
  record_items(elsewhere, {second, second});
  EXPECT_THROW(all.take_least(fewer), std::invalid_argument);
  EXPECT_THROW(all.take_least(elsewhere), std::invalid_argument);
}

/// Whether it gets the core or not: a run leaves the same stretches every time.
TEST(Recording, IsTheSameEveryTimeButForCosts) {
  const auto recorded = [](Recording& recording) {
    const Executor executor({.threads = 8, .recording = &recording});
    std::vector<int> values(5000);
    for (int loop = 0; loop < 20; ++loop)
      parallel_for(executor, values.size(), [&](std::size_t i) { values[i] += loop; });
  };
  Recording once, again;
  recorded(once);
  recorded(again);
  const double before = replay(once, {}).total.work;
  EXPECT_NO_THROW(once.take_least(again));
  EXPECT_LE(replay(once, {}).total.work, before);
  EXPECT_LE(replay(once, {}).total.work, replay(again, {}).total.work);
}

TEST(Recording, SurvivesAnExceptionInALoop) {
  Recording recording;
  const Executor executor({.threads = 2, .recording = &recording});
  const auto throwing = [](std::size_t i) {
    if (i == 500) throw 1;
  };
  EXPECT_THROW(parallel_for(executor, 1000, throwing, {.grain = 10}), int);
  std::size_t count = 0;
  for (const auto& stretch : recording.stretches()) count += stretch.count;
  EXPECT_EQ(count, recording.costs().size());
}

/// Every item takes part in `steps` rounds; planning costs 1000, applying 3000.
class Countdown {
 public:
  using Item = std::uint32_t;
  using Plan = std::uint32_t;
  struct Update {};

  Countdown(std::size_t n, int steps) : left(n, steps) {}
  std::optional<Plan> plan(Item item) const {
    return left[item] > 0 ? std::optional(item) : std::nullopt;
  }
  void conflicts(Item, auto&&) const {}
  std::size_t item_count() const { return left.size(); }
  void apply(const Plan& item, Commit<Countdown>& commit) {
    if (--left[item] > 0) commit.wake(item);
  }
  void commit(std::uint32_t, const Update&) {}
  double plan_cost(Item) const { return 1000; }
  double apply_cost(Plan) const { return 3000; }

  std::vector<int> left;  // [item]
};
static_assert(CostedOperator<Countdown>);

TEST(Recording, TakesCostsFromTheOperator) {
  Recording recording;
  const Executor executor({.threads = 32, .recording = &recording});
  Countdown countdown(40960, 2);
  std::vector<std::uint32_t> work(40960);
  std::iota(work.begin(), work.end(), 0U);
  recording.begin_section("countdown");
  const RoundsReport report = run_rounds(executor, countdown, work, {.window = 0});
  EXPECT_EQ(report.rounds, 2U);
  EXPECT_EQ(report.batches, 2U);
  EXPECT_EQ(report.woken, 40960U);
  const auto phase = [&](int threads, Phase which) {
    const Replay result = replay(recording, {.threads = threads, .launch_ns = 0});
    return result.sections[1].times_of[static_cast<std::size_t>(which)];
  };
  EXPECT_NEAR(phase(1, Phase::plan).work, 2 * 40960e-6, 1e-6);
  EXPECT_NEAR(phase(10, Phase::plan).work, 2 * 40960e-6, 1e-6);
  EXPECT_NEAR(phase(10, Phase::apply).work, 2 * 122880e-6, 1e-6);
  // Small serial parts between the loops are measured, so the bounds are one-sided.
  EXPECT_GE(phase(10, Phase::apply).elapsed, 2 * 12288e-6 - 1e-6);
  EXPECT_NEAR(phase(10, Phase::apply).elapsed - phase(10, Phase::apply).serial, 2 * 12288e-6, 1e-6);
}

TEST(Recording, ChangesNoResult) {
  Recording recording;
  std::vector<std::uint32_t> work(5000);
  std::iota(work.begin(), work.end(), 0U);
  Countdown recorded(5000, 3), plain(5000, 3);
  run_rounds(Executor({.threads = 4, .recording = &recording}), recorded, work);
  run_rounds(Executor({.threads = 4}), plain, work);
  EXPECT_EQ(recorded.left, plain.left);
  EXPECT_EQ(recording.rounds(), 3U);
}

}  // namespace
}  // namespace ductile::runtime::replay_test
