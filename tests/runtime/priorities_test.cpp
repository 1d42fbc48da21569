/// @file
/// Rounds of items with priorities: a greedy matching of weighted edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/runtime/detail/reservation_rounds.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::priorities_test {
namespace {

using test::ReachAny;
using test::thread_counts;
using test::Vertex;

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

/// Within one window, whose items run until none is left, the result is the greedy matching.
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

/// Keys of reservations are used up after 4,000 million items, or fewer for a test.
TEST(Reservations, GoOnWhenTheirKeysAreUsedUp) {
  using Rounds = detail::ReservationRounds<WeightedMatching>;
  constexpr Vertex vertices = 5000;
  constexpr std::size_t most_passes = 200;
  const auto edges = random_edges(vertices, 40000, 3);
  WeightedMatching expected(vertices), matching(vertices);
  const Executor executor({.threads = 2});
  const auto many = Rounds(executor, expected).run(edges, most_passes);
  const auto few =
      Rounds(executor, matching, Rounds::Windows::most_items + 100).run(edges, most_passes);
  EXPECT_EQ(many.left, 0U);
  EXPECT_EQ(few.left, 0U);
  EXPECT_EQ(matching.partner_of, expected.partner_of);
}

}  // namespace
}  // namespace ductile::runtime::priorities_test
