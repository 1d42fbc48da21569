#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "expect_caught.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::test {
namespace {

struct EliminationFaults {
  bool hides_neighbours = false, revives = false;
};

/// Eliminates vertices, those of least degree first; the neighbours of each become a clique. A
/// vertex's note depends on the vertices eliminated before it.
class Elimination {
 public:
  struct Item {
    Vertex vertex;
    std::uint32_t degree, version;
  };
  struct Plan {
    std::vector<Vertex> neighbours;
    friend bool operator==(const Plan&, const Plan&) = default;
  };

  Elimination(std::uint64_t seed, std::size_t n, std::size_t m, EliminationFaults faults = {})
      : beside(n), version(n), note(n), faults_(faults) {
    for (std::size_t e = 0; e < m; ++e) {
      const auto a = static_cast<Vertex>(mix64(seed << 32U | 2 * e) % n);
      const auto b = static_cast<Vertex>(mix64(seed << 32U | (2 * e + 1)) % n);
      if (a == b) continue;
      beside[a].insert(b);
      beside[b].insert(a);
    }
  }

  std::vector<Item> all_items() const {
    std::vector<Item> items;
    for (Vertex v = 0; v < beside.size(); ++v) items.push_back(item_of(v));
    return items;
  }

  std::size_t resource_count() const { return beside.size(); }
  std::uint32_t level(const Item& item) const { return item.degree; }
  bool plan(const Item& item, Plan& plan, auto& reach) const {
    if (throws_at == item.vertex) throw std::runtime_error("on purpose");
    if (!reach(item.vertex)) return false;
    if (version[item.vertex] != item.version && !(faults_.revives && item.vertex % 2 == 0))
      return false;
    plan.neighbours.assign(beside[item.vertex].begin(), beside[item.vertex].end());
    if (!faults_.hides_neighbours)
      for (const Vertex other : plan.neighbours)
        if (!reach(other)) return false;
    // The fault to be detected: an item without a plan gets one when a neighbour is eliminated.
    return !faults_.revives || version[item.vertex] % 2 == 0;
  }
  void apply(const Item& item, Plan& plan, auto& commit) {
    for (const Vertex v : plan.neighbours) {
      note[item.vertex] = mix64(note[item.vertex] + note[v] + v);
      beside[v].erase(item.vertex);
      for (const Vertex other : plan.neighbours)
        if (other != v) beside[v].insert(other);
    }
    ++version[item.vertex];
    note[item.vertex] += 1;
    for (const Vertex v : plan.neighbours) {
      note[v] = mix64(note[v] + note[item.vertex]);
      ++version[v];
      commit.wake(item_of(v));
    }
    beside[item.vertex].clear();
  }

  friend bool operator==(const Elimination& a, const Elimination& b) {
    return a.note == b.note && a.version == b.version && a.beside == b.beside;
  }

  std::vector<std::set<Vertex>> beside;  // [vertex]
  std::vector<std::uint32_t> version;    // [vertex]
  std::vector<std::uint64_t> note;       // [vertex]
  Vertex throws_at = 0xffffffffU;

 private:
  Item item_of(Vertex v) const {
    return {v, static_cast<std::uint32_t>(beside[v].size()), version[v]};
  }

  EliminationFaults faults_;
};
static_assert(LevelledOperator<Elimination>);

/// The reference: a map of levels, independent of the runtime.
void eliminate_plainly(Elimination& op) {
  std::map<std::uint32_t, std::vector<Elimination::Item>> waiting;
  for (const auto& item : op.all_items()) waiting[item.degree].push_back(item);
  struct Commit {
    std::map<std::uint32_t, std::vector<Elimination::Item>>& waiting;
    std::uint32_t lowest;
    void wake(const Elimination::Item& item) {
      waiting[std::max(lowest, item.degree)].push_back(item);
    }
  };
  const auto reach = [](Vertex) { return true; };
  while (!waiting.empty()) {
    const std::uint32_t lowest = waiting.begin()->first;
    Commit commit{waiting, lowest};
    std::size_t next = 0;
    while (next < waiting[lowest].size()) {
      const Elimination::Item item = waiting[lowest][next++];
      Elimination::Plan plan;
      if (op.plan(item, plan, reach)) op.apply(item, plan, commit);
    }
    waiting.erase(lowest);
  }
}

/// Runs all rounds on several threads; a whole run does that only where it was faster so far.
template <class Op>
RoundsReport run_at_once(const Executor& executor, Op& op,
                         const std::vector<typename Op::Item>& work) {
  return detail::run_by_level(executor, op, work, std::numeric_limits<std::size_t>::max(),
                              detail::Sharing::always);
}

/// Vertices and edges: few and many vertices; hardly any edges, and enough for cliques to grow.
constexpr std::pair<std::size_t, std::size_t> sizes[] = {{1, 0},     {7, 9},       {60, 100},
                                                         {300, 400}, {2000, 1700}, {20000, 10000}};

TEST(LevelRounds, GiveWhatAPlainLoopGivesAtAnyNumberOfThreads) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const auto& [n, m] : sizes) {
      if (seed > 1 && n > 1000) continue;
      Elimination plain(seed, n, m);
      eliminate_plainly(plain);
      for (const int threads : thread_counts) {
        const Executor executor({.threads = threads});
        Elimination op(seed, n, m), at_once(seed, n, m);
        const RoundsReport report = run_rounds(executor, op, op.all_items());
        EXPECT_EQ(report.applied, n);
        EXPECT_EQ(report.left, 0U);
        ASSERT_TRUE(op == plain) << n << ", " << threads << " threads";
        run_at_once(executor, at_once, at_once.all_items());
        ASSERT_TRUE(at_once == plain) << n << ", " << threads << " threads";
      }
    }
}

TEST(LevelRounds, GiveTheSameWhenChecked) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Elimination plain(seed, 80, 110), checked(seed, 80, 110);
    eliminate_plainly(plain);
    const RoundsReport report = run_rounds_checked(Executor(), checked, checked.all_items());
    EXPECT_EQ(report.applied, 80U);
    ASSERT_TRUE(checked == plain) << seed;
  }
}

TEST(LevelRounds, RunThoughTheExecutorNeedNotBeDeterministic) {
  Elimination plain(1, 3000, 3000), op(1, 3000, 3000);
  eliminate_plainly(plain);
  run_rounds(Executor({.threads = 3, .deterministic = false}), op, op.all_items());
  EXPECT_TRUE(op == plain);
}

TEST(LevelRounds, StopWhereRoundsAreLimited) {
  for (const int threads : thread_counts) {
    Elimination op(1, 3000, 3000);
    const RoundsReport report =
        run_rounds(Executor({.threads = threads}), op, op.all_items(), {.most_rounds = 2});
    EXPECT_EQ(report.rounds, 2U);
    EXPECT_GT(report.left, 0U);
  }
}

TEST(LevelRounds, RunWithoutWork) {
  Elimination op(1, 10, 10);
  EXPECT_EQ(run_rounds(Executor({.threads = 2}), op, {}).rounds, 0U);
}

TEST(LevelRounds, RefuseStrategiesWithoutLevels) {
  for (const Strategy strategy : {Strategy::regions, Strategy::in_order}) {
    Elimination op(1, 10, 10);
    const Executor executor({.threads = 2});
    EXPECT_THROW(run_rounds(executor, op, op.all_items(), {.strategy = strategy}),
                 std::invalid_argument);
    EXPECT_THROW(run_rounds_checked(executor, op, op.all_items(), {.strategy = strategy}),
                 std::invalid_argument);
  }
  Elimination op(1, 10, 10);
  EXPECT_THROW(applied_in_order(Executor(), op, op.all_items()), std::invalid_argument);
}

TEST(LevelRounds, PassOnWhatOperatorsThrow) {
  for (const int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Elimination op(1, 20000, 10000), at_once(1, 20000, 10000);
    op.throws_at = at_once.throws_at = 17000;
    EXPECT_THROW(run_rounds(executor, op, op.all_items()), std::runtime_error);
    EXPECT_THROW(run_at_once(executor, at_once, at_once.all_items()), std::runtime_error);
  }
}

// ---- What is checked ----

TEST(LevelRounds, AreCheckedForReachesAndOrder) {
  const Elimination hidden(1, 80, 110, {.hides_neighbours = true});
  expect_caught(ContractRule::touches_announced, hidden, hidden.all_items());
  const Elimination revived(1, 80, 110, {.revives = true});
  expect_caught(ContractRule::order_kept, revived, revived.all_items());
}

/// Passes small numbers on along a line. Levels are far apart, up to the greatest possible one.
template <bool tells>
class Lowering {
 public:
  struct Item {
    Vertex vertex;
    std::uint32_t value;
  };
  struct Plan {
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  explicit Lowering(std::size_t n) : least(n, std::numeric_limits<std::uint32_t>::max()) {}

  std::vector<Item> start() {
    std::vector<Item> items;
    for (Vertex v = 0; v < least.size(); v += 3) items.push_back({v, least[v] = first(v)});
    return items;
  }
  std::size_t resource_count() const { return least.size(); }
  std::uint32_t level(const Item& item) const { return item.value; }
  bool plan(const Item& item, Plan&, auto& reach) const {
    return reach(item.vertex) && least[item.vertex] == item.value;
  }
  void apply(const Item& item, Plan&, auto& commit) {
    for (const Vertex other : {item.vertex - 1, item.vertex + 1}) {
      if (other >= least.size()) continue;
      if (atomic_min(least[other], item.value)) commit.wake({other, item.value});
    }
  }
  static std::uint32_t first(Vertex v) {
    return ~static_cast<std::uint32_t>(mix64(v)) >> mix64(v + 1) % 32;
  }

  std::vector<std::uint32_t> least;  // [vertex]
};
struct LoweringThatTells : Lowering<true> {
  using Lowering::Lowering;
  static constexpr bool lowers_minima = true;
};

TEST(LevelRounds, LowerMinima) {
  for (const std::size_t n : {1, 2, 50, 20000}) {
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    for (Vertex v = 0; v < n; v += 3) least = std::min(least, LoweringThatTells::first(v));
    for (const int threads : thread_counts) {
      LoweringThatTells op(n);
      run_rounds(Executor({.threads = threads}), op, op.start());
      EXPECT_EQ(op.least, std::vector<std::uint32_t>(n, least)) << threads;
      LoweringThatTells at_once(n);
      run_at_once(Executor({.threads = threads}), at_once, at_once.start());
      EXPECT_EQ(at_once.least, std::vector<std::uint32_t>(n, least)) << threads;
    }
    if (n > 100) continue;
    LoweringThatTells checked(n);
    run_rounds_checked(Executor(), checked, checked.start());
    EXPECT_EQ(checked.least, std::vector<std::uint32_t>(n, least));
  }
  Lowering<false> silent(50);
  const auto work = silent.start();
  expect_caught(ContractRule::touches_announced, silent, work);
}

// ---- Parts ----

TEST(ItemsByLevel, AreTakenLowestFirstInTheOrderInWhichTheyCame) {
  const Elimination op(1, 1, 0);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    std::uint64_t state = seed;
    const auto random = [&](std::uint64_t below) { return (state = mix64(state + 1)) % below; };
    detail::ItemsByLevel<Elimination> items(op);
    std::map<std::uint32_t, std::vector<Vertex>> model;
    const std::uint64_t range = std::uint64_t{1} << random(33);
    std::uint32_t lowest = 0;
    std::size_t count = 0;
    for (int step = 0; step < 60; ++step) {
      for (std::uint64_t more = random(12); more > 0; --more) {
        const auto level = static_cast<std::uint32_t>(random(range));
        const auto number = static_cast<Vertex>(random(1000));
        items.add({number, level, 0});
        model[std::max(level, lowest)].push_back(number);
        ++count;
      }
      ASSERT_EQ(items.size(), count);
      std::vector<Elimination::Item> taken;
      ASSERT_EQ(items.take_lowest(taken), !model.empty());
      if (model.empty()) continue;
      lowest = model.begin()->first;
      std::vector<Vertex> numbers;
      for (const auto& item : taken) numbers.push_back(item.vertex);
      ASSERT_EQ(numbers, model.begin()->second);
      model.erase(model.begin());
      count -= taken.size();
    }
  }
}

}  // namespace
}  // namespace ductile::runtime::test
