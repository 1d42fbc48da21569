#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/detail/numbers.hpp"
#include "ductile/runtime/detail/region_map.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"
#include "split_intervals.hpp"

namespace ductile::runtime::test {
namespace {

template <class T>
class Strategies : public testing::Test {};
using Dims =
    testing::Types<std::integral_constant<std::size_t, 2>, std::integral_constant<std::size_t, 3>>;
TYPED_TEST_SUITE(Strategies, Dims);

/// Few and many intervals become few and many: run one by one, in regions, and both.
TYPED_TEST(Strategies, SplitTheSameAtAnyNumberOfThreads) {
  for (const auto& [count, length] :
       {std::pair<std::size_t, double>{1, 1e-3}, {7, 0.4}, {50, 2.5e-5}, {40000, 3e-5}})
    for (const Strategy strategy : {Strategy::automatic, Strategy::reservations}) {
      if (strategy == Strategy::reservations && count == 1) continue;
      std::set<std::uint64_t> results;
      for (const int threads : thread_counts) {
        SplitIntervals<TypeParam::value> op(count, length);
        const RoundsReport report =
            run_rounds(Executor({.threads = threads}), op, op.all_items(), {.strategy = strategy});
        ASSERT_TRUE(op.is_whole()) << count << ", " << threads << " threads";
        EXPECT_EQ(report.applied, op.intervals.size() - count);
        EXPECT_EQ(report.left, 0U);
        results.insert(op.hash());
      }
      EXPECT_EQ(results.size(), 1U) << count;
    }
}

/// Plans demand three points and take one.
TEST(Strategies, LeaveNoHoles) {
  for (const Strategy strategy : {Strategy::regions, Strategy::reservations})
    for (const std::size_t count : {10, 40000}) {
      SplitIntervals<2> op(count, 2e-5, {.demanded = 3});
      run_rounds(Executor({.threads = 3}), op, op.all_items(), {.strategy = strategy});
      EXPECT_TRUE(op.is_whole()) << static_cast<int>(strategy) << ", " << count;
    }
}

TEST(Strategies, SayWhereMoreNumbersAreTakenThanDemanded) {
  SplitIntervals<2> op(4000, 2e-5, {.takes_too_many = true});
  EXPECT_THROW(run_rounds(Executor({.threads = 3}), op, op.all_items(),
                          {.strategy = Strategy::reservations}),
               std::logic_error);
}

TEST(Strategies, StopWhereRoundsAreLimited) {
  for (const Strategy strategy : {Strategy::regions, Strategy::reservations}) {
    SplitIntervals<2> op(100000, 4e-6);
    const RoundsReport report = run_rounds(Executor({.threads = 2}), op, op.all_items(),
                                           {.strategy = strategy, .most_rounds = 1});
    EXPECT_EQ(report.rounds, 1U);
    EXPECT_GT(report.left, 0U);
    EXPECT_FALSE(op.is_whole());
  }
}

TEST(Strategies, EndIfPlansDemandMoreNumbersThanPartsGet) {
  SplitIntervals<2> op(50000, 1.5e-5, {.demanded = 200000});
  const RoundsReport report = run_rounds(Executor({.threads = 2}), op, op.all_items());
  EXPECT_TRUE(op.is_whole());
  EXPECT_LT(report.rounds, 10U);
}

TEST(Strategies, RunInsideALoopAndWithoutWork) {
  const Executor executor({.threads = 3});
  std::vector<std::uint64_t> hash(4);
  parallel_for(executor, hash.size(), [&](std::size_t i) {
    SplitIntervals<2> op(50000, 1e-5);
    run_rounds(executor, op, op.all_items());
    hash[i] = op.is_whole() ? op.hash() : i;
  });
  EXPECT_EQ(std::set(hash.begin(), hash.end()).size(), 1U);
  SplitIntervals<2> nothing(0, 1);
  EXPECT_EQ(run_rounds(executor, nothing, nothing.all_items()).rounds, 0U);
}

// ---- In order ----

/// Each vertex takes the lowest colour that no neighbour before it in the work has.
class GreedyColours {
 public:
  using Item = Vertex;
  struct Plan {
    std::uint32_t colour;
  };
  explicit GreedyColours(const CsrRows& rows)
      : colour_of(rows.view().vertex_count()), rows_(rows) {}

  std::size_t resource_count() const { return colour_of.size(); }
  void conflicts(Vertex vertex, auto&& visit) const {
    rows_.view().for_each_neighbour(vertex, visit);
  }
  bool plan(Vertex vertex, Plan& plan, auto& reach) const {
    if (throws_at == vertex) throw std::runtime_error("on purpose");
    if (!reach(vertex) || colour_of[vertex] != 0) return false;
    std::set<std::uint32_t> taken;
    for (const Vertex other : rows_.view().row(vertex)) {
      if (!reach(other)) return false;
      taken.insert(colour_of[other]);
    }
    plan.colour = 1;
    while (taken.contains(plan.colour)) ++plan.colour;
    return true;
  }
  void apply(Vertex vertex, Plan& plan, auto& commit) {
    colour_of[vertex] = plan.colour;
    if (wakes) commit.wake(vertex);
  }

  std::vector<std::uint32_t> colour_of;
  Vertex throws_at = 0xffffffffU;
  bool wakes = false;

 private:
  const CsrRows& rows_;
};

/// A graph of n vertices with the edges (a(i), b(i)) for i below m.
CsrRows graph_of(std::size_t n, std::size_t m, auto&& a, auto&& b) {
  std::vector<std::set<Vertex>> row(n);
  for (std::size_t i = 0; i < m; ++i) {
    const auto from = static_cast<Vertex>(a(i)), to = static_cast<Vertex>(b(i));
    if (from == to) continue;
    row[from].insert(to);
    row[to].insert(from);
  }
  CsrRows rows{{0}, {}};
  for (const auto& one : row) {
    rows.neighbour.insert(rows.neighbour.end(), one.begin(), one.end());
    rows.offset.push_back(static_cast<std::uint32_t>(rows.neighbour.size()));
  }
  return rows;
}

/// Graphs of several windows: a path and random edges. Smaller ones: no edges, a star, neighbours
/// close in the order.
std::vector<CsrRows> graphs() {
  constexpr std::size_t n = 6000, many = 40000;
  const auto self = [](std::size_t i) { return i; };
  std::vector<CsrRows> all;
  all.push_back(graph_of(many, many - 1, self, [](std::size_t i) { return i + 1; }));
  all.push_back(graph_of(
      many, 2 * many, [](std::size_t i) { return mix64(2 * i) % many; },
      [](std::size_t i) { return mix64(2 * i + 1) % many; }));
  all.push_back(graph_of(n, 0, self, self));
  all.push_back(graph_of(
      n, n, [](std::size_t) { return n / 2; }, self));
  all.push_back(graph_of(
      n, 3 * n, [](std::size_t i) { return mix64(i) % n; },
      [](std::size_t i) { return (mix64(i) % n + 1 + i % 300) % n; }));
  return all;
}

/// Runs all of the work on several threads; a whole run does that only where it was faster so far.
/// Returns the applied items.
template <class Op, class Work>
std::vector<Vertex> run_at_once(const Executor& executor, Op& op, const Work& work) {
  std::vector<Vertex> applied;
  const auto note = [&](Vertex item) { applied.push_back(item); };
  const RoundsReport report =
      detail::run_in_order(executor, op, work, note, detail::Sharing::always);
  EXPECT_EQ(report.applied, applied.size());
  EXPECT_GE(report.planned, work.size());
  return applied;
}

std::vector<Vertex> shuffled(std::vector<Vertex> items) {
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[mix64(i) % i]);
  return items;
}

TEST(InOrder, GivesWhatAPlainLoopGives) {
  for (const CsrRows& rows : graphs()) {
    const std::size_t n = rows.view().vertex_count();
    std::vector<Vertex> some = shuffled(all_items(n));
    some.resize(n / 2);
    for (const auto& work : {all_items(n), shuffled(all_items(n)), some}) {
      GreedyColours plain(rows);
      const RoundsReport one = run_rounds(Executor({.threads = 1}), plain, work);
      EXPECT_EQ(one.applied, work.size());
      for (const int threads : thread_counts) {
        GreedyColours op(rows);
        RoundsReport report;
        EXPECT_EQ(applied_in_order(Executor({.threads = threads}), op, work, &report), work);
        EXPECT_EQ(report.applied, work.size());
        ASSERT_EQ(op.colour_of, plain.colour_of) << threads;
        GreedyColours again(rows);
        EXPECT_EQ(run_at_once(Executor({.threads = threads}), again, work), work);
        ASSERT_EQ(again.colour_of, plain.colour_of) << threads;
      }
    }
  }
}

/// Joins pairs of free numbers; has no conflicts().
class Pairing {
 public:
  using Item = std::uint32_t;
  struct Plan {
    std::uint32_t a, b;
  };
  Pairing(std::size_t count, std::size_t pairs) : partner_of(count, count), pairs_(pairs) {}

  std::size_t resource_count() const { return partner_of.size(); }
  bool plan(Item item, Plan& plan, auto& reach) const {
    if (throws_at == item) throw std::runtime_error("on purpose");
    plan.a = static_cast<std::uint32_t>(mix64(2 * item) % partner_of.size());
    plan.b = static_cast<std::uint32_t>(mix64(2 * item + 1) % partner_of.size());
    return plan.a != plan.b && reach(plan.a) && is_free(plan.a) && reach(plan.b) && is_free(plan.b);
  }
  void apply(Item, Plan& plan, auto&) {
    partner_of[plan.a] = plan.b;
    partner_of[plan.b] = plan.a;
  }

  std::vector<std::size_t> partner_of;
  std::uint32_t throws_at = 0xffffffffU;

 private:
  bool is_free(std::uint32_t i) const { return partner_of[i] == partner_of.size(); }
  std::size_t pairs_;
};

TEST(InOrder, GivesWhatAPlainLoopGivesWithoutConflicts) {
  for (const auto& [count, pairs] : {std::pair<std::size_t, std::uint32_t>{50000, 200000},
                                     {300, 50000},
                                     {2, 9000},
                                     {200000, 100000}}) {
    Pairing plain(count, pairs);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < pairs; ++i) {
      Pairing::Plan plan{};
      detail::ReachAll reach;
      if (!plain.plan(i, plan, reach)) continue;
      plain.apply(i, plan, reach);
      expected.push_back(i);
    }
    for (const int threads : thread_counts) {
      Pairing op(count, pairs);
      const Executor executor({.threads = threads});
      EXPECT_EQ(applied_in_order(executor, op, AllNumbers(pairs)), expected);
      ASSERT_EQ(op.partner_of, plain.partner_of) << threads;
      Pairing again(count, pairs);
      EXPECT_EQ(run_at_once(executor, again, all_items(pairs)), expected);
      ASSERT_EQ(again.partner_of, plain.partner_of) << threads;
    }
  }
}

// ---- Errors ----

TEST(Strategies, SayWhatAnOperatorLacks) {
  const Executor executor({.threads = 2});
  Pairing pairing(10, 10);
  for (const Strategy strategy : {Strategy::tiles, Strategy::colours})
    EXPECT_THROW(run_rounds(executor, pairing, all_items(10), {.strategy = strategy}),
                 std::invalid_argument);
  SplitIntervals<2> split(10, 1e-2);
  EXPECT_THROW(run_rounds(executor, split, split.all_items(), {.strategy = Strategy::in_order}),
               std::invalid_argument);
}

TEST(Strategies, PassOnWhatOperatorsThrow) {
  const CsrRows rows = graphs()[1];
  for (const int threads : thread_counts) {
    const Executor executor({.threads = threads});
    GreedyColours thrower(rows), waker(rows);
    thrower.throws_at = 9000;
    waker.wakes = true;
    const auto work = all_items(20000);
    EXPECT_THROW(run_rounds(executor, thrower, work), std::runtime_error);
    EXPECT_THROW(run_at_once(executor, thrower, work), std::runtime_error);
    EXPECT_THROW(run_rounds(executor, waker, work), std::logic_error);
    EXPECT_THROW(run_at_once(executor, waker, work), std::logic_error);
    Pairing ordered(5000, 20000);
    ordered.throws_at = 15000;
    EXPECT_THROW(run_at_once(executor, ordered, work), std::runtime_error);
    for (const Strategy strategy :
         {Strategy::automatic, Strategy::in_order, Strategy::reservations}) {
      Pairing pairing(5000, 20000);
      pairing.throws_at = 15000;
      EXPECT_THROW(run_rounds(executor, pairing, all_items(20000), {.strategy = strategy}),
                   std::runtime_error);
    }
  }
}

// ---- Parts ----

TEST(Numbers, AreDealtOutOnceAndClosedUp) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::uint64_t state = seed;
    const auto random = [&](std::size_t below) { return (state = mix64(state + 1)) % below; };
    detail::Numbers numbers(random(100));
    std::set<std::uint32_t> used;
    for (std::uint32_t i = 0; i < numbers.top(); ++i) used.insert(i);
    for (int phase = 0; phase < 6; ++phase) {
      std::vector<detail::NumberPool> pools(1 + random(5));
      numbers.deal(pools, [&](std::size_t) { return random(40); });
      for (detail::NumberPool& pool : pools)
        for (std::size_t take = random(40); take > 0 && pool.left() > 0; --take)
          ASSERT_TRUE(used.insert(pool.take()).second);
      numbers.take_back(pools);
      ASSERT_EQ(numbers.used(), used.size());
      std::vector<std::uint32_t> visited;
      numbers.for_each_used([&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) visited.push_back(i);
      });
      ASSERT_TRUE(std::equal(visited.begin(), visited.end(), used.begin(), used.end()));
    }
    const std::size_t count = used.size();
    for (const auto [from, to] : numbers.close_holes()) {
      EXPECT_EQ(used.erase(from), 1U);
      EXPECT_TRUE(used.insert(to).second);
    }
    EXPECT_EQ(numbers.top(), count);
    EXPECT_TRUE(used.empty() || *used.rbegin() + 1 == count);
  }
}

TYPED_TEST(Strategies, MapRegionsOfEqualSizes) {
  constexpr std::size_t n = 60000, regions = 7;
  constexpr std::size_t dim = TypeParam::value;
  const auto place_of = [](std::uint32_t r) {
    std::array<double, dim> place;
    for (std::size_t i = 0; i < dim; ++i)
      place[i] = static_cast<double>(mix64(3 * std::uint64_t{r} + i) % 1000000);
    return place;
  };
  std::set<std::vector<std::uint16_t>> cuts;
  for (const std::uint64_t turn : {1, 2, 3})
    for (const int threads : thread_counts) {
      detail::RegionMap<dim> map;
      map.cut(Executor({.threads = threads}), detail::Numbers(n), place_of, {regions, turn, 0});
      std::vector<std::uint16_t> owner_of(n);
      std::array<std::size_t, regions> size{};
      for (std::uint32_t r = 0; r < n; ++r) ++size[owner_of[r] = map.owner_of(r)];
      EXPECT_LT(*std::max_element(size.begin(), size.end()),
                1.2 * static_cast<double>(*std::min_element(size.begin(), size.end())));
      cuts.insert(owner_of);
    }
  EXPECT_EQ(cuts.size(), 3U) << "expected one cut per turn, the same at any number of threads";
}

}  // namespace
}  // namespace ductile::runtime::test
