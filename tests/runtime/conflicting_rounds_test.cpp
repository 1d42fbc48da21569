/// @file
/// Operators with conflicts, in tiles and in colours: turns, wakes, exceptions and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "contract.hpp"
#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::conflicting_rounds_test {
namespace {

using test::all_items;
using test::Contract;
using test::thread_counts;
using test::Vertex;
using test::works;

/// Vertices of a grid, numbered row by row. Each takes the mean of its neighbours, so that the
/// order of any two neighbours affects the last bit.
class Mean {
 public:
  using Item = Vertex;
  struct Plan {
    double value;
  };

  explicit Mean(Vertex side) : value(std::size_t{side} * side), turns(value.size()), side_(side) {
    for (std::size_t v = 0; v < value.size(); ++v) value[v] = std::sin(static_cast<double>(v * v));
  }

  bool plan(Vertex v, Plan& plan, auto& reach) const {
    bool reached = reach(v);
    double sum = 0;
    int count = 0;
    conflicts(v, [&](Vertex other) {
      reached = reached && reach(other);
      sum += value[other], ++count;
    });
    plan.value = sum / count;
    return reached;
  }
  void conflicts(Vertex v, auto&& visit) const {
    const Vertex column = v % side_, row = v / side_;
    if (column > 0) visit(v - 1);
    if (column + 1 < side_) visit(v + 1);
    if (row > 0) visit(v - side_);
    if (row + 1 < side_) visit(v + side_);
  }
  std::size_t resource_count() const { return value.size(); }
  void apply(Vertex v, const Plan& plan, auto& commit) {
    value[v] = plan.value;
    if (++turns[v] > 1) return;
    if (wakes) conflicts(v, [&](Vertex other) { commit.wake(other); });
    if (postpones) conflicts(v, [&](Vertex other) { commit.postpone(other); });
  }

  std::vector<double> value;  // [vertex]
  std::vector<int> turns;     // [vertex], so far
  bool wakes = false, postpones = false;

 private:
  Vertex side_;
};

/// Each vertex of a row makes up to two things, possibly fewer than it has demanded, and is noted
/// by its neighbours.
class Make {
 public:
  using Item = Vertex;
  struct Plan {
    std::uint32_t count;
  };
  static constexpr bool forgoes_wakes = true;

  Make(const Executor& executor, Vertex vertices) : noted(vertices), deferred_(executor) {}

  bool plan(Vertex v, Plan& plan, auto& reach) const {
    bool reached = reach(v);
    conflicts(v, [&](Vertex other) { reached = reached && reach(other); });
    plan.count = v % 3;
    return reached;
  }
  void conflicts(Vertex v, auto&& visit) const {
    if (v > 0) visit(v - 1);
    if (v + 1 < noted.size()) visit(v + 1);
  }
  std::size_t resource_count() const { return noted.size(); }
  void apply(Vertex v, const Plan& plan, auto& commit) {
    for (std::uint32_t i = 0; i < plan.count; ++i) maker_of[commit.fresh(1)] = v;
    conflicts(v, [&](Vertex other) { deferred_.mine().defer(other, v); });
  }
  std::size_t commit() {
    return deferred_.commit([&](Vertex owner, Vertex by) { noted[owner].insert(by); });
  }

  std::array<std::uint32_t, 2> demand(const Plan& plan) const { return {0, plan.count | 1U}; }
  std::array<std::size_t, 2> counts() const { return {noted.size(), maker_of.size()}; }
  void grow(const std::array<std::size_t, 2>& room) { maker_of.resize(room[1]); }
  void renumber(std::size_t kind, std::span<const Renumbered> moved, std::size_t count) {
    if (kind == 0) return;
    for (const auto& [from, to] : moved) maker_of[to] = maker_of[from];
    maker_of.resize(count);
  }

  std::vector<std::set<Vertex>> noted;  // [vertex], neighbours
  std::vector<Vertex> maker_of;         // [thing]

 private:
  DeferredUpdate<Vertex> deferred_;
};

TEST(Colours, MakeThingsAndCommitWhatIsDeferred) {
  constexpr Vertex vertices = 50000;  // more of a colour than are planned together
  std::vector<Vertex> expected;
  for (const int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Make make(executor, vertices);
    const RoundsReport report =
        run_rounds(executor, make, all_items(vertices), {.strategy = Strategy::colours});
    EXPECT_EQ(report.applied, vertices);
    EXPECT_EQ(report.committed, 2 * (vertices - 1));
    for (Vertex v = 0; v < vertices; ++v)
      EXPECT_EQ(make.noted[v].size(), v == 0 || v + 1 == vertices ? 1U : 2U);
    if (expected.empty()) expected = make.maker_of;
    EXPECT_EQ(make.maker_of, expected) << threads << " threads";
    std::vector<Vertex> count_of(vertices);
    for (const Vertex v : make.maker_of) ++count_of[v];
    for (Vertex v = 0; v < vertices; ++v) EXPECT_EQ(count_of[v], v % 3);
  }
  const Executor executor({.threads = 2});
  Make make(executor, 300);
  run_rounds_checked(executor, make, all_items(300), {.strategy = Strategy::colours});
}

class ByConflicts : public testing::TestWithParam<Strategy> {};
INSTANTIATE_TEST_SUITE_P(Strategies, ByConflicts,
                         testing::Values(Strategy::tiles, Strategy::colours),
                         [](const auto& strategy) {
                           return strategy.param == Strategy::tiles ? "Tiles" : "Colours";
                         });

TEST_P(ByConflicts, EveryItemHasOneTurnWhateverTheThreads) {
  constexpr Vertex side = 150;
  const auto work = all_items(side * side);
  std::vector<double> expected;
  for (const int threads : thread_counts) {
    Mean mean(side);
    const RoundsReport report =
        run_rounds(Executor({.threads = threads}), mean, work, {.strategy = GetParam()});
    EXPECT_EQ(report.planned, work.size());
    EXPECT_EQ(report.applied, work.size());
    EXPECT_EQ(mean.turns, std::vector<int>(work.size(), 1)) << threads << " threads";
    if (expected.empty()) expected = mean.value;
    EXPECT_EQ(mean.value, expected) << threads << " threads";
  }
}

/// In the first round each item has its turn; items that come before a neighbour have another one.
TEST_P(ByConflicts, AWokenItemThatStillWaitsHasItsTurnInTheRound) {
  constexpr Vertex side = 60;
  std::vector<int> expected;
  for (const int threads : thread_counts) {
    Mean mean(side);
    mean.wakes = true;
    const RoundsReport report =
        run_rounds(Executor({.threads = threads}), mean, all_items(side * side),
                   {.strategy = GetParam(), .most_rounds = 1});
    EXPECT_EQ(report.applied + report.lost, side * side);
    EXPECT_LT(report.lost, side * side / 10);  // late ones
    EXPECT_GT(report.left, report.lost);
    EXPECT_LT(report.left, side * side);
    if (expected.empty()) expected = mean.turns;
    EXPECT_EQ(mean.turns, expected) << threads << " threads";
  }
}

TEST_P(ByConflicts, APostponedItemLeavesTheRoundAndComesBack) {
  constexpr Vertex side = 60;
  std::vector<double> expected;
  for (const int threads : thread_counts) {
    Mean mean(side);
    mean.postpones = true;
    const RoundsReport report = run_rounds(Executor({.threads = threads}), mean,
                                           all_items(side * side), {.strategy = GetParam()});
    EXPECT_GT(report.rounds, 1U);
    EXPECT_GT(report.lost, 0U);
    EXPECT_EQ(report.left, 0U);
    EXPECT_EQ(*std::min_element(mean.turns.begin(), mean.turns.end()), 1);
    if (expected.empty()) expected = mean.value;
    EXPECT_EQ(mean.value, expected) << threads << " threads";
  }
}

TEST_P(ByConflicts, ConflictsMayChange) {
  constexpr Vertex side = 100;
  for (const auto& work : works(side)) {
    std::vector<std::set<Vertex>> expected;
    for (const int threads : thread_counts) {
      Contract contract(side);
      const RoundsReport report =
          run_rounds(Executor({.threads = threads}), contract, work, {.strategy = GetParam()});
      EXPECT_EQ(report.left, 0U);
      for (Vertex v = 0; v < side * side; ++v)
        for (const Vertex other : contract.neighbours[v])
          EXPECT_TRUE(contract.neighbours[other].contains(v));
      if (expected.empty()) expected = contract.neighbours;
      EXPECT_EQ(contract.neighbours, expected) << threads << " threads";
    }
  }
}

TEST_P(ByConflicts, WorkWithoutItemsIsNoRound) {
  Mean mean(3);
  const RoundsReport report =
      run_rounds(Executor(), mean, std::vector<Vertex>{}, {.strategy = GetParam()});
  EXPECT_EQ(report.rounds, 0U);
}

TEST_P(ByConflicts, RefuseItemsThatAreTwiceThereOrUnknown) {
  const Executor executor({.threads = 2});
  const auto run = [&](auto&& op, const std::vector<Vertex>& work) {
    run_rounds(executor, op, work, {.strategy = GetParam()});
  };
  EXPECT_THROW(run(Mean(5), {3, 4, 3}), std::invalid_argument);
  EXPECT_THROW(run(Mean(5), {3, 25}), std::out_of_range);
  Contract wakes(20);
  wakes.wakes_unknown = true;
  EXPECT_THROW(run(wakes, all_items(400)), std::out_of_range);
}

TEST_P(ByConflicts, PassOnWhatAnItemThrows) {
  constexpr Vertex side = 100;
  for (const int threads : thread_counts)
    for (const Vertex culprit : {0U, 5000U, side * side - 1}) {
      Contract contract(side);
      contract.throws_at = culprit;
      EXPECT_THROW(run_rounds(Executor({.threads = threads}), contract, all_items(side * side),
                              {.strategy = GetParam()}),
                   std::runtime_error);
    }
}

TEST(ByConflicts, TheCheckerSeesWhoseNewConflictIsNotTold) {
  const Executor executor({.threads = 1});
  const auto run = [&](Contract& op) {
    run_rounds_checked(executor, op, all_items(400), {.strategy = Strategy::tiles});
  };
  Contract sound(20), silent(20), wrong(20);
  EXPECT_NO_THROW(run(sound));
  const auto broken_rule = [&](Contract& op) {
    try {
      run(op);
    } catch (const ContractBroken& broken) {
      return broken.rule();
    }
    return ContractRule::nobody_woken;
  };
  silent.postpones_kept = false;
  EXPECT_EQ(broken_rule(silent), ContractRule::new_conflict_told);
  wrong.wakes_unknown = true;
  EXPECT_EQ(broken_rule(wrong), ContractRule::numbers_in_range);
}

}  // namespace
}  // namespace ductile::runtime::conflicting_rounds_test
