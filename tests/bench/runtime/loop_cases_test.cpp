#include "support/loop_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stdexcept>

namespace ductile::bench {
namespace {

/// Sets a variable of the environment for as long as it lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Environment() { ::unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

std::span<const std::uint32_t> units_of_shape(const std::string& shape) {
  for (const LoopCase& loop_case : loop_cases())
    if (loop_case.name.starts_with(shape + "_1e")) return units_of(loop_case);
  throw std::runtime_error("no shape " + shape);
}

double sum(std::span<const std::uint32_t> units) {
  return std::accumulate(units.begin(), units.end(), 0.0);
}

TEST(LoopCases, HaveTheMeanCostTheyPromise) {
  for (const LoopCase& loop_case : loop_cases()) {
    const auto units = units_of(loop_case);
    ASSERT_EQ(units.size(), loop_case.iterations) << loop_case.name;
    const double mean = sum(units) / static_cast<double>(units.size());
    // Costs are whole units.
    EXPECT_NEAR(mean, loop_case.mean_units, 0.5) << loop_case.name;
  }
}

TEST(LoopCases, HaveTheShapesTheirNamesSay) {
  const auto rising = units_of_shape("rising"), falling = units_of_shape("falling");
  EXPECT_TRUE(std::is_sorted(rising.begin(), rising.end()));
  EXPECT_TRUE(std::is_sorted(falling.begin(), falling.end(), std::greater<>()));
  const auto step = units_of_shape("step");
  EXPECT_NEAR(sum(step.subspan(step.size() / 2)) / sum(step.first(step.size() / 2)), 10, 0.5);
  const auto spike = units_of_shape("spike_at_end");
  EXPECT_NEAR(spike.back() / sum(spike.first(spike.size() - 1)), 0.3, 0.01);
  const auto exponential = units_of_shape("exponential");
  EXPECT_GT(sum(exponential.last(exponential.size() / 10)), 0.5 * sum(exponential));
}

TEST(Extent, ComesFromTheEnvironment) {
  {
    const Environment quick("DUCTILE_BENCH", "quick");
    EXPECT_EQ(by_extent(1, 2, 3), 1);
  }
  EXPECT_EQ(by_extent(1, 2, 3), 2);
  const Environment wrong("DUCTILE_BENCH", "fast");
  EXPECT_THROW(extent(), std::runtime_error);
}

TEST(ThreadCounts, AreThoseAskedFor) {
  {
    const Environment some("DUCTILE_BENCH_THREADS", "1 3 12");
    EXPECT_EQ(thread_counts(), (std::vector{1, 3, 12}));
    EXPECT_EQ(team_sizes(), (std::vector{3, 12}));
  }
  EXPECT_EQ(thread_counts().front(), 1);
  for (const char* const wrong : {"two", "1 0", "2,4"}) {
    const Environment environment("DUCTILE_BENCH_THREADS", wrong);
    EXPECT_THROW(thread_counts(), std::runtime_error) << wrong;
  }
}

TEST(PingPong, TakesATimeOrGivesUp) {
  const double ns = ping_pong_ns();
  EXPECT_GE(ns, 0);
  EXPECT_LT(ns, 20e6);  // the ping-pong gives up before that
}

}  // namespace
}  // namespace ductile::bench
