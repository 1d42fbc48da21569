#include "ductile/runtime/detail/surveyed_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::surveyed_tiles_test {
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
    Vertex gone, kept;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  struct Update {};
  static constexpr bool keeps_to_neighbours = true;
  static constexpr bool forgoes_wakes = true;

  explicit Contract(Vertex side)
      : neighbours(std::size_t{side} * side),
        turns(neighbours.size()),
        mutex_of_(std::make_unique<std::mutex[]>(neighbours.size())) {
    const auto join = [&](Vertex a, Vertex b) {
      neighbours[a].insert(b);
      neighbours[b].insert(a);
    };
    for (Vertex v = 0; v < neighbours.size(); ++v) {
      if (v % side + 1 < side) join(v, v + 1);
      if (v + side < neighbours.size()) join(v, v + side);
      if (v % side + 1 < side && v + side < neighbours.size()) join(v, v + side + 1);
    }
  }

  std::optional<Plan> plan(Vertex v) const {
    if (v == throws_at) throw std::runtime_error("plan");
    const std::set<Vertex>& around = neighbours[v];
    if (around.empty() || around.size() > 7 || mix32(v) % 3 == 0) return {};
    return Plan{v, *std::next(around.begin(), mix32(v) % static_cast<Vertex>(around.size()))};
  }
  void conflicts(Vertex v, auto&& visit) const {
    for (const Vertex other : neighbours[v]) visit(other);
  }
  std::size_t item_count() const { return neighbours.size(); }
  void prefetch(Vertex, int) const {}

  void apply(const Plan& plan, auto& commit) {
    ++turns[plan.gone];
    const std::set<Vertex> around = std::move(neighbours[plan.gone]);
    neighbours[plan.gone].clear();
    for (const Vertex other : around) {
      const std::lock_guard held(mutex_of_[other]);
      neighbours[other].erase(plan.gone);
      if (other == plan.kept) {
        neighbours[other].insert(around.begin(), around.end());
        neighbours[other].erase(plan.kept);
      } else {
        neighbours[other].insert(plan.kept);
        if (other % 4 == 0) commit.reconsider(other);
      }
    }
    commit.wake(plan.kept);
  }
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::set<Vertex>> neighbours;  // [vertex]
  std::vector<int> turns;                    // [vertex], how often it was applied
  Vertex throws_at = ~0U;

 private:
  std::unique_ptr<std::mutex[]> mutex_of_;
};

static_assert(TiledOperator<Contract> && !SteadyTiledOperator<Contract>);

/// Rounds of Contract one item after the other, by the definition of their order.
class InTurn {
 public:
  explicit InTurn(Contract& op) : op_(op) {}

  /// Returns the next round's work.
  std::vector<Vertex> run(const std::vector<Vertex>& work) {
    woken_.clear();
    turn_of_.clear();
    const int bits = std::clamp(static_cast<int>(std::bit_width(work.size())) - 11, 1, 6);
    const detail::BlockLayout layout{static_cast<unsigned>(bits), 5};
    const auto tile_at = [&](std::size_t place) { return place >> layout.block_bits; };
    std::vector<std::size_t> place_of(op_.item_count(), work.size());
    for (std::size_t i = 0; i < work.size(); ++i) {
      turn_of_[work[i]] = {detail::rank_of_block(layout, tile_at(i)), i};
      place_of[work[i]] = i;
    }
    std::vector<Vertex> order;
    for (const Vertex v : work) {
      bool waits = false;
      op_.conflicts(v, [&](Vertex other) {
        if (turn_of_.count(other) == 0) return;
        waits = waits || (turn_of_[other].first == turn_of_[v].first &&
                          tile_at(place_of[other]) < tile_at(place_of[v]));
      });
      waits ? wake(v) : order.push_back(v);
    }
    late += woken_.size();
    std::sort(order.begin(), order.end(),
              [&](Vertex a, Vertex b) { return turn_of_[a] < turn_of_[b]; });
    for (const Vertex v : order) {
      if (woken_.count(v) != 0) continue;
      now_ = v;
      if (const auto plan = op_.plan(v)) op_.apply(*plan, *this);
    }
    return {woken_.begin(), woken_.end()};
  }

  void wake(Vertex v) { woken_.insert(v); }
  void reconsider(Vertex v) {
    if (turn_of_.count(v) == 0 || turn_of_[v] < turn_of_[now_]) wake(v);
  }

  std::size_t late = 0;

 private:
  Contract& op_;
  std::map<Vertex, std::pair<std::uint8_t, std::size_t>> turn_of_;
  std::set<Vertex> woken_;
  Vertex now_ = 0;
};

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

TEST(SurveyedTiles, RunByTheirRanksAndWakeWhomAnEqualOneComesBefore) {
  constexpr Vertex side = 150;
  for (const auto& work : works(side))
    for (const int rounds : {1, 30}) {
      Contract expected(side);
      InTurn in_turn(expected);
      std::vector<Vertex> left = work;
      for (int round = 0; round < rounds && !left.empty(); ++round) left = in_turn.run(left);
      if (work.size() == expected.item_count()) {
        EXPECT_GT(in_turn.late, 0U);
      }
      for (const int threads : thread_counts) {
        Contract contract(side);
        const Executor executor({.threads = threads});
        const RoundsReport report = run_rounds(executor, contract, work, {.most_rounds = rounds});
        EXPECT_EQ(contract.neighbours, expected.neighbours) << threads << " threads";
        EXPECT_EQ(contract.turns, expected.turns);
        EXPECT_EQ(report.left, left.size());
        EXPECT_EQ(report.committed, 0U);
      }
    }
}

TEST(SurveyedTiles, CountWhoLeavesTheRound) {
  constexpr Vertex side = 100;
  const auto work = all_items(side * side);
  Contract contract(side);
  const RoundsReport report =
      run_rounds(Executor({.threads = 2}), contract, work, {.most_rounds = 1});
  EXPECT_EQ(report.batches, 1U);
  EXPECT_EQ(report.planned + report.dropped, work.size());
  EXPECT_GT(report.dropped, 0U);
  EXPECT_EQ(report.applied,
            static_cast<std::size_t>(std::count(contract.turns.begin(), contract.turns.end(), 1)));
}

/// Of few vertices, as a check plans all that wait after each batch.
TEST(SurveyedTiles, AreForOperatorsThatKeepTheContract) {
  constexpr Vertex side = 20;
  Contract contract(side);
  EXPECT_GT(run_rounds_checked(Executor({.threads = 1}), contract, all_items(side * side)).applied,
            side);
}

TEST(SurveyedTiles, PassOnWhatAnItemThrows) {
  constexpr Vertex side = 150;
  for (const int threads : thread_counts)
    for (const Vertex culprit : {0U, 5000U, side * side - 1}) {
      Contract contract(side);
      contract.throws_at = culprit;
      EXPECT_THROW(run_rounds(Executor({.threads = threads}), contract, all_items(side * side)),
                   std::runtime_error);
    }
}

/// More than fit at once into what collects the tiles that an item meets.
TEST(SurveyedTiles, MeetAnyNumberOfTiles) {
  constexpr Vertex side = 150;
  Contract expected(side);
  for (Vertex v = 0; v + 1 < side * side; v += 3) {  // all around the last one
    expected.neighbours[v].insert(side * side - 1);
    expected.neighbours[side * side - 1].insert(v);
  }
  Contract contract(side);
  contract.neighbours = expected.neighbours;
  InTurn(expected).run(all_items(side * side));
  run_rounds(Executor({.threads = 4}), contract, all_items(side * side), {.most_rounds = 1});
  EXPECT_EQ(contract.neighbours, expected.neighbours);
}

}  // namespace
}  // namespace ductile::runtime::surveyed_tiles_test
