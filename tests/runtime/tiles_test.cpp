/// @file
/// Tiles against a run of one item after the other, by the definition of their order.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "contract.hpp"
#include "ductile/runtime/detail/ranked_blocks.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::tiles_test {
namespace {

using test::all_items;
using test::Contract;
using test::ReachAny;
using test::thread_counts;
using test::Vertex;
using test::works;

/// When an item has its turn, by the definition of tiles.
struct Turn {
  std::uint8_t rank = 0;
  std::size_t place = 0;
  auto operator<=>(const Turn&) const = default;
};

/// The commit argument of apply() in this test's own run of Contract.
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
/// Runs a round in tiles one item after the other, by the definition of their order. Returns the
/// next round's work and adds the items that are postponed to `late`.
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

TEST(Tiles, RunByTheirRanksAndPostponeWhomAnEqualOneComesBefore) {
  constexpr Vertex side = 100;
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

/// The last vertex touches more tiles than the buffer for an item's tiles holds.
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

}  // namespace
}  // namespace ductile::runtime::tiles_test
