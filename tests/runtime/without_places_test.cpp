#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::test {
namespace {

/// A ring in which every vertex is tied to the `reach` vertices on each side, numbered along the
/// ring or at random. Each vertex mixes its neighbours' values into its own `turns` times and wakes
/// those that have turns left, so that another order gives other values.
class MixOnARing {
 public:
  using Item = Vertex;
  struct Plan {
    std::uint64_t sum = 0;
    bool operator==(const Plan&) const = default;
  };

  MixOnARing(std::size_t n, bool in_random_order, std::uint32_t turns = 3)
      : value(n), at_(all_items(n)), number_(all_items(n)), left_(n, turns) {
    if (in_random_order)
      for (std::size_t i = n; i > 1; --i) std::swap(number_[i - 1], number_[mix64(i) % i]);
    for (std::size_t i = 0; i < n; ++i) at_[number_[i]] = static_cast<Vertex>(i);
    for (std::size_t v = 0; v < n; ++v) value[v] = mix64(v);
  }

  std::size_t resource_count() const { return value.size(); }

  bool plan(Vertex v, Plan& plan, auto& reach) const {
    plan.sum = 0;
    if (!reach(v)) return false;
    for (std::size_t step = 1; step <= reached_on_each_side; ++step)
      for (const Vertex other : {beside(v, step), beside(v, value.size() - step)}) {
        if (!reach(other)) return false;
        plan.sum += value[other];
      }
    return left_[v] > 0;
  }

  void apply(Vertex v, Plan& plan, auto& commit) {
    value[v] = mix64(value[v] + plan.sum);
    if (--left_[v] > 0) commit.wake(v);
  }

  bool is_done() const {
    return std::all_of(left_.begin(), left_.end(), [](std::uint32_t left) { return left == 0; });
  }

  std::vector<std::uint64_t> value;  // [vertex]

 private:
  static constexpr std::size_t reached_on_each_side = 2;

  Vertex beside(Vertex v, std::size_t step) const {
    return number_[(at_[v] + step) % number_.size()];
  }

  std::vector<Vertex> at_, number_;  // [vertex], its place in the ring; and the reverse
  std::vector<std::uint32_t> left_;  // [vertex], turns
};

/// Too few to cut, few and many regions; in_random_order most items reach into other regions.
TEST(RegionsWithoutPlaces, GiveTheSameAtAnyNumberOfThreads) {
  for (const std::size_t n : {std::size_t{10}, std::size_t{2000}, std::size_t{150000}})
    for (const bool in_random_order : {false, true}) {
      std::set<std::vector<std::uint64_t>> results;
      for (const int threads : thread_counts) {
        MixOnARing op(n, in_random_order);
        const RoundsReport report = run_rounds(Executor({.threads = threads}), op, all_items(n));
        EXPECT_TRUE(op.is_done());
        EXPECT_EQ(report.applied, 3 * n);
        results.insert(op.value);
      }
      EXPECT_EQ(results.size(), 1U) << n << ", " << in_random_order;
    }
}

/// An item is planned again for every phase in which it waits: less than once on average.
TEST(RegionsWithoutPlaces, WasteFewPlans) {
  constexpr std::size_t n = 150000;
  for (const bool in_random_order : {false, true}) {
    MixOnARing op(n, in_random_order);
    const RoundsReport report = run_rounds(Executor({.threads = 2}), op, all_items(n));
    EXPECT_LE(report.planned, 5 * n) << in_random_order;
  }
}

TEST(RegionsWithoutPlaces, KeepTheContract) {
  for (const bool in_random_order : {false, true}) {
    MixOnARing op(400, in_random_order);
    run_rounds_checked(Executor({.threads = 2}), op, all_items(400));
    EXPECT_TRUE(op.is_done());
  }
}

}  // namespace
}  // namespace ductile::runtime::test
