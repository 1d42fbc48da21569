/// @file
/// Operators with conflicts: tiles and colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/deferred_update.hpp"
#include "ductile/runtime/detail/ranked_blocks.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::conflicting_rounds_test {
namespace {

using test::all_items;
using test::thread_counts;
using test::Vertex;

/// Contracts edges of a graph: a vertex of few neighbours goes, one of them takes over the others.
/// So conflicts change, and two that do not conflict may change the neighbours of a third.
class Contract {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex kept;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  static constexpr bool forgoes_wakes = true;

  explicit Contract(Vertex side)
      : neighbours(std::size_t{side} * side),
        turns(neighbours.size()),
        mutex_of_(std::make_unique<std::mutex[]>(neighbours.size())) {
    for (Vertex v = 0; v < neighbours.size(); ++v) {
      if (v % side + 1 < side) join(v, v + 1);
      if (v + side < neighbours.size()) join(v, v + side);
      if (v % side + 1 < side && v + side < neighbours.size()) join(v, v + side + 1);
    }
  }
  void join(Vertex a, Vertex b) {
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }

  bool plan(Vertex v, Plan& plan, auto& reach) const {
    if (v == throws_at) throw std::runtime_error("plan");
    if (!reach(v)) return false;
    const std::set<Vertex>& around = neighbours[v];
    for (const Vertex other : around)
      if (!reach(other)) return false;
    if (around.empty() || around.size() > 7 || mix32(v) % 3 == 0) return false;
    plan.kept = *std::next(around.begin(), mix32(v) % static_cast<Vertex>(around.size()));
    return true;
  }
  void conflicts(Vertex v, auto&& visit) const {
    for (const Vertex other : neighbours[v]) visit(other);
  }
  std::size_t resource_count() const { return neighbours.size(); }

  void apply(Vertex gone, const Plan& plan, auto& commit) {
    ++turns[gone];
    const std::set<Vertex> around = std::move(neighbours[gone]);
    neighbours[gone].clear();
    for (const Vertex other : around) {
      const std::lock_guard held(mutex_of_[other]);
      neighbours[other].erase(gone);
      if (other == plan.kept) {
        neighbours[other].insert(around.begin(), around.end());
        neighbours[other].erase(plan.kept);
      } else {
        neighbours[other].insert(plan.kept);
        if (other % 4 == 0) commit.wake(other);
      }
    }
    if (postpones_kept) commit.postpone(plan.kept);
    if (wakes_unknown) commit.wake(static_cast<Vertex>(neighbours.size()));
  }

  std::vector<std::set<Vertex>> neighbours;  // [vertex]
  std::vector<int> turns;                    // [vertex], how often it was applied
  Vertex throws_at = ~0U;
  bool postpones_kept = true, wakes_unknown = false;

 private:
  std::unique_ptr<std::mutex[]> mutex_of_;
};

/// When an item has its turn, by the definition of tiles.
struct Turn {
  std::uint8_t rank = 0;
  std::size_t place = 0;
  auto operator<=>(const Turn&) const = default;
};

/// What a test's own run of Contract hands to apply().
struct Woken {
  std::map<Vertex, Turn> turn_of;
  std::set<Vertex> items, postponed;
  Turn now;
  void wake(Vertex v) {
    const auto found = turn_of.find(v);
    if (found == turn_of.end() || found->second <= now) items.insert(v);
  }
  void postpone(Vertex v) {
    items.insert(v);
    postponed.insert(v);
  }
};
struct ReachAny {
  bool operator()(Vertex) const { return true; }
};

/// A round in tiles one item after the other, by the definition of their order. Returns the next
/// round's work; counts who is late.
std::vector<Vertex> run_in_turn(Contract& op, const std::vector<Vertex>& work, std::size_t& late) {
  Woken woken;
  const int bits = std::clamp(static_cast<int>(std::bit_width(work.size())) - 11, 1, 6);
  const detail::BlockLayout layout{static_cast<unsigned>(bits), 5};
  std::map<Vertex, Turn>& turn_of = woken.turn_of;
  for (std::size_t i = 0; i < work.size(); ++i)
    turn_of[work[i]] = {layout.rank_of(i >> layout.block_bits), i};
  std::vector<Vertex> order;
  for (const Vertex v : work) {
    const Turn own = turn_of[v];
    bool is_late = false;
    op.conflicts(v, [&](Vertex other) {
      const auto found = turn_of.find(other);
      if (found == turn_of.end()) return;
      const Turn turn = found->second;
      is_late = is_late || (turn.rank == own.rank &&
                            turn.place >> layout.block_bits < own.place >> layout.block_bits);
    });
    if (is_late) {
      woken.items.insert(v);
      ++late;
    } else {
      order.push_back(v);
    }
  }
  std::sort(order.begin(), order.end(),
            [&](Vertex a, Vertex b) { return turn_of[a] < turn_of[b]; });
  ReachAny reach;
  for (const Vertex v : order) {
    Contract::Plan plan{};
    woken.now = turn_of[v];
    if (!woken.postponed.contains(v) && op.plan(v, plan, reach)) op.apply(v, plan, woken);
  }
  return {woken.items.begin(), woken.items.end()};
}

/// Works of many and few items, side by side and apart, in order and not.
std::vector<std::vector<Vertex>> works(Vertex side) {
  std::vector<std::vector<Vertex>> works{all_items(side * side), {}, {}, {side + 1}};
  for (Vertex v = 0; v < side * side; v += 7) works[1].push_back(v);
  for (Vertex v = 0; v < 100; ++v) works[2].push_back(mix32(v) % (side * side));
  std::sort(works[2].begin(), works[2].end());
  works[2].erase(std::unique(works[2].begin(), works[2].end()), works[2].end());
  std::reverse(works[2].begin(), works[2].end());
  return works;
}

TEST(Tiles, RunByTheirRanksAndPostponeWhomAnEqualOneComesBefore) {
  constexpr Vertex side = 150;
  for (const auto& work : works(side))
    for (const int rounds : {1, 30}) {
      Contract expected(side);
      std::size_t late = 0;
      std::vector<Vertex> left = work;
      for (int round = 0; round < rounds && !left.empty(); ++round)
        left = run_in_turn(expected, left, late);
      EXPECT_TRUE(work.size() < expected.resource_count() || late > 0);
      for (const int threads : thread_counts) {
        Contract contract(side);
        const RoundsReport report =
            run_rounds(Executor({.threads = threads}), contract, work,
                       {.strategy = Strategy::tiles, .most_rounds = rounds});
        EXPECT_EQ(contract.neighbours, expected.neighbours) << threads << " threads";
        EXPECT_EQ(contract.turns, expected.turns);
        EXPECT_EQ(report.left, left.size());
      }
    }
}

/// More than fit at once into what collects the tiles that an item meets.
TEST(Tiles, MeetAnyNumberOfTiles) {
  constexpr Vertex side = 150;
  Contract expected(side), contract(side);
  for (Vertex v = 0; v + 1 < side * side; v += 3)  // all around the last one
    for (Contract* op : {&expected, &contract}) op->join(v, side * side - 1);
  std::size_t late = 0;
  run_in_turn(expected, all_items(side * side), late);
  run_rounds(Executor({.threads = 4}), contract, all_items(side * side),
             {.strategy = Strategy::tiles, .most_rounds = 1});
  EXPECT_EQ(contract.neighbours, expected.neighbours);
}

/// Vertices of a grid whose rows are numbered one after the other; each takes on the mean of its
/// neighbours, so that the order of any two neighbours shows in the last bit.
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

/// Each vertex of a row makes up to two things, of which it may have asked for one more, and is
/// noted by its neighbours.
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
  constexpr Vertex vertices = 50000;  // more than are planned together of a colour
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

/// In the first round each item has its turn, and those that come before a neighbour have another.
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

// ---- Prefetching ----

/// Each item once; notes which stages it was asked for ahead.
struct AskedAhead {
  using Item = Vertex;
  struct Plan {};
  explicit AskedAhead(Vertex n) : stages(n), planned(n) {}

  bool plan(Vertex v, Plan&, auto& reach) const {
    planned[v] = stages[v];
    return reach(v);
  }
  void apply(Vertex, Plan&, auto&) {}
  std::size_t resource_count() const { return stages.size(); }
  void prefetch(Vertex v, int stage) const { stages[v] |= 1U << static_cast<unsigned>(stage); }

  mutable std::vector<unsigned> stages, planned;  // [vertex], bits
};
struct AskedAheadInTiles : AskedAhead {
  using AskedAhead::AskedAhead;
  void conflicts(Vertex, auto&&) const {}
};

TEST(Prefetching, IsAskedForInAllStages) {
  constexpr Vertex n = 5000;
  const auto asked = [](const AskedAhead& op) {
    return std::count(op.planned.begin(), op.planned.end(), 7U);
  };
  AskedAheadInTiles in_tiles(n);
  run_rounds(Executor({.threads = 1}), in_tiles, all_items(n), {.strategy = Strategy::tiles});
  EXPECT_EQ(asked(in_tiles), n);
  AskedAhead reserving(n);
  run_rounds(Executor({.threads = 1}), reserving, all_items(n),
             {.strategy = Strategy::reservations});
  EXPECT_GT(asked(reserving), n - 64);
}

// ---- Priorities ----

/// Edges of a graph; those of the lowest weight match first.
struct WeightedMatching {
  struct Item {
    Vertex a, b;
    std::uint32_t weight;
  };
  struct Plan {};
  explicit WeightedMatching(std::size_t vertices) : partner_of(vertices, ~0U) {}

  bool plan(const Item& edge, Plan&, auto& reach) const {
    if (!reach(edge.a) || !reach(edge.b)) return false;
    return partner_of[edge.a] == ~0U && partner_of[edge.b] == ~0U;
  }
  void apply(const Item& edge, Plan&, auto&) {
    partner_of[edge.a] = edge.b;
    partner_of[edge.b] = edge.a;
  }
  std::size_t resource_count() const { return partner_of.size(); }
  std::uint32_t priority(const Item& edge) const { return edge.weight; }

  std::vector<Vertex> partner_of;  // [vertex]
};

std::vector<WeightedMatching::Item> random_edges(Vertex vertices, std::size_t count,
                                                 std::uint32_t seed) {
  std::vector<WeightedMatching::Item> edges;
  for (std::uint32_t i = 0; edges.size() < count; ++i) {
    const Vertex a = mix32(seed + 3 * i) % vertices, b = mix32(seed + 3 * i + 1) % vertices;
    if (a != b) edges.push_back({a, b, mix32(seed + 3 * i + 2)});  // above 2^31, too
  }
  return edges;
}

/// Of one window, all of which are looked at again until none is left, that is the greedy matching.
TEST(Priorities, DecideWhoWins) {
  for (std::uint32_t seed = 1; seed < 200; ++seed) {
    const auto edges = random_edges(20, 60, 1000 * seed);
    auto sorted = edges;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.weight < b.weight; });
    WeightedMatching expected(20);
    WeightedMatching::Plan plan;
    ReachAny reach;
    for (const auto& edge : sorted)
      if (expected.plan(edge, plan, reach)) expected.apply(edge, plan, reach);
    for (const int threads : thread_counts) {
      WeightedMatching matching(20);
      run_rounds(Executor({.threads = threads}), matching, edges,
                 {.strategy = Strategy::reservations});
      EXPECT_EQ(matching.partner_of, expected.partner_of) << seed;
    }
  }
}

TEST(Priorities, GiveAMaximalMatchingOfMany) {
  constexpr Vertex vertices = 50000;
  const auto edges = random_edges(vertices, 200000, 7);
  std::vector<Vertex> expected;
  for (const int threads : thread_counts) {
    WeightedMatching matching(vertices);
    run_rounds(Executor({.threads = threads}), matching, edges,
               {.strategy = Strategy::reservations});
    for (const auto& edge : edges)
      EXPECT_FALSE(matching.partner_of[edge.a] == ~0U && matching.partner_of[edge.b] == ~0U);
    if (expected.empty()) expected = matching.partner_of;
    EXPECT_EQ(matching.partner_of, expected) << threads << " threads";
  }
}

}  // namespace
}  // namespace ductile::runtime::conflicting_rounds_test
