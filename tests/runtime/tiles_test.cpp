#include "ductile/runtime/detail/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::tiles_test {
namespace {

using test::all_items;
using test::thread_counts;
using test::Vertex;

/// Vertices of a grid whose rows are numbered one after the other; each takes on the mean of its
/// neighbours, so that the order of any two neighbours shows in the last bit.
class Mean {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex vertex;
    double value;
  };
  struct Update {};
  static constexpr bool keeps_conflicts = true;
  static constexpr bool keeps_to_neighbours = true;

  explicit Mean(Vertex side) : value(std::size_t{side} * side), turns(value.size()), side_(side) {
    for (std::size_t v = 0; v < value.size(); ++v) value[v] = std::sin(static_cast<double>(v * v));
  }

  std::optional<Plan> plan(Vertex v) const {
    if (v == throws_at) throw std::runtime_error("plan");
    double sum = 0;
    int count = 0;
    conflicts(v, [&](Vertex other) { sum += value[other], ++count; });
    return Plan{v, sum / count};
  }
  void conflicts(Vertex v, auto&& visit) const {
    const Vertex column = v % side_, row = v / side_;
    if (column > 0) visit(v - 1);
    if (column + 1 < side_) visit(v + 1);
    if (row > 0) visit(v - side_);
    if (row + 1 < side_) visit(v + side_);
  }
  std::size_t item_count() const { return value.size(); }
  void prefetch(Vertex, int) const {}
  void prefetch_neighbour(Vertex) const { neighbours_fetched.fetch_add(1); }  // in tiles only
  void apply(const Plan& plan, Commit<Mean>& commit) {
    value[plan.vertex] = plan.value;
    if (++turns[plan.vertex] == 1 && wakes)
      conflicts(plan.vertex, [&](Vertex other) { commit.wake(other); });
  }
  void commit(std::uint32_t, const Update&) {}

  static inline std::atomic<std::size_t> neighbours_fetched{0};
  std::vector<double> value;  // [vertex]
  std::vector<int> turns;     // [vertex], so far
  Vertex throws_at = ~0U;
  bool wakes = true;

 private:
  Vertex side_;
};

static_assert(SteadyTiledOperator<Mean>);

struct Outcome {
  Mean mean;
  RoundsReport report;
};

Outcome run(Vertex side, int threads, const std::vector<Vertex>& work, int rounds = 1) {
  Outcome outcome{Mean(side), {}};
  const Executor executor({.threads = threads});
  outcome.report = run_rounds(executor, outcome.mean, work, {.most_rounds = rounds});
  return outcome;
}

TEST(Tiles, GiveEveryItemOneTurnWhateverTheThreads) {
  constexpr Vertex side = 150;
  const auto work = all_items(side * side);
  const Outcome first = run(side, 1, work);
  for (const int threads : thread_counts) {
    Mean::neighbours_fetched = 0;
    const Outcome outcome = run(side, threads, work);
    EXPECT_GT(Mean::neighbours_fetched, 0U);
    EXPECT_GT(outcome.report.batches, 1U);  // the tiles, then those of what was left
    EXPECT_EQ(outcome.report.planned, work.size());
    EXPECT_EQ(outcome.report.applied, work.size());
    EXPECT_EQ(outcome.mean.turns, std::vector<int>(work.size(), 1)) << threads << " threads";
    EXPECT_EQ(outcome.mean.value, first.mean.value) << threads << " threads";
  }
}

/// What tiles of all items are to give, by the definition of their order.
TEST(Tiles, RunByTheirRanksAndLeaveWhomAnEqualOneComesBefore) {
  constexpr Vertex side = 150;
  const auto work = all_items(side * side);
  Mean expected(side);
  const detail::BlockLayout layout = detail::tiles_of(work.size());
  const auto rank = [&](Vertex v) { return 7 * layout.step_of(v) % layout.step_count(); };
  std::vector<std::uint8_t> left(work.size());
  const auto is_left = [&](Vertex v) {
    bool any = false;
    expected.conflicts(v, [&](Vertex other) {
      any = any || (other < v && !layout.same_block(other, v) && rank(other) == rank(v));
    });
    return any;
  };
  std::transform(work.begin(), work.end(), left.begin(), is_left);
  EXPECT_GT(std::count(left.begin(), left.end(), 1), 0);
  auto order = work;
  std::stable_sort(order.begin(), order.end(),
                   [&](Vertex a, Vertex b) { return rank(a) < rank(b); });
  for (const Vertex v : order)
    if (left[v] == 0) expected.value[v] = expected.plan(v)->value;

  for (const int threads : thread_counts) {
    const Executor executor({.threads = threads});
    Mean mean(side);
    mean.wakes = false;
    detail::Tiles<Mean> tiles(executor, mean, work);
    tiles.run([] { return Commit<Mean>(); }, [](Vertex) {});
    EXPECT_TRUE(std::equal(tiles.left().begin(), tiles.left().end(), left.begin(), left.end()));
    EXPECT_EQ(mean.value, expected.value) << threads << " threads";
  }
}

TEST(Tiles, LeaveFewItemsOfManyToTilesOfTheirOwn) {
  constexpr Vertex side = 700;  // 490,000 vertices, of which 4900 are work
  std::vector<Vertex> work(4900);
  for (std::size_t i = 0; i < work.size(); ++i) work[i] = static_cast<Vertex>(100 * i);
  Mean::neighbours_fetched = 0;
  const Outcome first = run(side, 1, work);
  EXPECT_EQ(Mean::neighbours_fetched, 0U);
  EXPECT_EQ(first.report.applied, work.size());
  EXPECT_EQ(run(side, 8, work).mean.value, first.mean.value);
}

TEST(Tiles, PassOnWhatAnItemThrows) {
  constexpr Vertex side = 150;
  for (const int threads : thread_counts)
    for (const Vertex culprit : {0U, 5000U, side * side - 1}) {
      Mean mean(side);
      mean.throws_at = culprit;
      const Executor executor({.threads = threads});
      EXPECT_THROW(run_rounds(executor, mean, all_items(side * side)), std::runtime_error);
    }
}

TEST(Tiles, TakeWorkInAnyOrder) {
  constexpr Vertex side = 90;
  auto work = all_items(side * side);
  const Outcome first = run(side, 2, work);
  std::reverse(work.begin(), work.end());
  EXPECT_EQ(run(side, 2, work).mean.value, first.mean.value);
}

TEST(Tiles, WakeNeighboursThatHadTheirTurn) {
  constexpr Vertex side = 100;
  const auto work = all_items(side * side);
  const Outcome first = run(side, 1, work, 2);
  EXPECT_EQ(first.report.rounds, 2U);
  // Of two neighbours the one that comes first is woken by the other.
  EXPECT_GT(first.report.applied, work.size() * 3 / 2);
  EXPECT_LT(first.report.applied, work.size() * 2);
  for (const int threads : thread_counts) {
    const Outcome outcome = run(side, threads, work, 2);
    EXPECT_EQ(outcome.report.applied, first.report.applied);
    EXPECT_EQ(outcome.mean.value, first.mean.value) << threads << " threads";
  }
}

}  // namespace
}  // namespace ductile::runtime::tiles_test
