/// @file
/// run_rounds with operators that reserve; run_rounds_test.cpp has those that colour.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::reservations_test {
namespace {

using test::all_items;
using test::thread_counts;
using test::Vertex;

// ---- Matching: by reservations, heavier edges first, each match makes a new vertex ----

struct Edge {
  Vertex a, b;
  std::uint32_t weight;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// An edge between two free vertices is contracted to a new vertex.
class Matching {
 public:
  using Item = Edge;
  using Plan = Edge;
  struct Update {
    Vertex parent;
  };

  explicit Matching(std::size_t n) : parent(n, free) {}

  std::optional<Plan> plan(const Edge& edge) const {
    if (parent[edge.a] != free || parent[edge.b] != free) return {};
    return edge;
  }
  void footprint(const Edge& edge, auto&& visit) const {
    if (parent[edge.a] != free || parent[edge.b] != free) return;
    visit(edge.a);
    visit(edge.b);
  }
  std::size_t resource_count() const { return parent.size(); }
  std::uint8_t priority(const Edge& edge) const {
    return static_cast<std::uint8_t>(255 - edge.weight);
  }
  std::array<std::uint32_t, 1> demand(const Plan&) const { return {1}; }
  std::array<std::uint32_t, 1> grow(const std::array<std::uint32_t, 1>& total) {
    const auto first = static_cast<std::uint32_t>(parent.size());
    parent.resize(parent.size() + total[0], free);
    matched.resize(matched.size() + total[0]);
    return {first};
  }
  void apply(const Plan& edge, Commit<Matching>& commit) {
    const Vertex fresh = commit.fresh();
    matched[fresh - (parent.size() - matched.size())] = edge;
    commit.defer(edge.a, {fresh});
    commit.defer(edge.b, {fresh});
  }
  void commit(std::uint32_t owner, const Update& update) { parent[owner] = update.parent; }

  static constexpr Vertex free = 0xffffffffU;
  std::vector<Vertex> parent;  // [vertex], new ones at the end
  std::vector<Edge> matched;   // [new vertex]
};

std::vector<Edge> random_edges(Vertex n, bool distinct) {
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < 4 * n; ++i) {
    const Vertex a = mix32(2 * i) % n, b = mix32(2 * i + 1) % n;
    if (a != b) edges.push_back({a, b, distinct ? i % 256 : mix32(i) % 256});
  }
  return edges;
}

void expect_maximal(const Matching& result, const std::vector<Edge>& edges) {
  std::vector<int> uses(result.parent.size(), 0);
  for (const Edge& edge : result.matched) ++uses[edge.a], ++uses[edge.b];
  EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 1);
  for (const Edge& edge : edges) EXPECT_TRUE(uses[edge.a] == 1 || uses[edge.b] == 1);
  for (std::size_t i = 0; i < result.matched.size(); ++i) {
    const auto fresh = static_cast<Vertex>(result.parent.size() - result.matched.size() + i);
    EXPECT_EQ(result.parent[result.matched[i].a], fresh);
    EXPECT_EQ(result.parent[result.matched[i].b], fresh);
  }
}

TEST(RunRounds, MatchesByReservationTheSameAtEachThreadCount) {
  const auto edges = random_edges(3000, false);
  std::vector<Edge> first;
  for (const int threads : thread_counts)
    for (int run = 0; run < 2; ++run) {
      Matching matching(3000);
      const RoundsReport report = run_rounds(Executor({.threads = threads}), matching, edges);
      expect_maximal(matching, edges);
      EXPECT_EQ(report.applied, matching.matched.size());
      EXPECT_GT(report.lost, 0U);
      if (first.empty()) first = matching.matched;
      EXPECT_EQ(matching.matched, first) << threads << " threads";
    }
}

TEST(RunRounds, MatchesByReservationInArrivalOrder) {
  const auto edges = random_edges(3000, false);
  for (int run = 0; run < 5; ++run) {
    for (const std::size_t window : {0, 37}) {
      Matching matching(3000);
      run_rounds(Executor({.threads = 4, .deterministic = false}), matching, edges,
                 {.reserving_window = window});
      expect_maximal(matching, edges);
    }
  }
}

TEST(RunRounds, WindowsOfReservationsDoNotChangeWhatIsReached) {
  const auto edges = random_edges(3000, false);
  for (const std::size_t window : {1, 37, 1000, 5000, 100000}) {
    SCOPED_TRACE(window);
    std::vector<Edge> first;
    for (const int threads : thread_counts) {
      Matching matching(3000);
      const RoundsReport report =
          run_rounds(Executor({.threads = threads}), matching, edges, {.reserving_window = window});
      expect_maximal(matching, edges);
      EXPECT_EQ(report.applied, matching.matched.size());
      if (first.empty()) first = matching.matched;
      EXPECT_EQ(matching.matched, first) << threads << " threads";
    }
  }
}

TEST(RunRounds, AnEarlierWindowOfReservationsGoesFirst) {
  const std::vector<Edge> path = {{0, 1, 1}, {2, 3, 1}, {1, 2, 9}};  // heavier edges go first
  Matching all_at_once(4), by_two(4);
  run_rounds(Executor({.threads = 2}), all_at_once, path);
  run_rounds(Executor({.threads = 2}), by_two, path, {.reserving_window = 2});
  EXPECT_EQ(all_at_once.matched, std::vector(path.begin() + 2, path.end()));
  EXPECT_EQ(by_two.matched.size(), 2U);
}

/// With priorities that all differ, reservations give what greed in the order of priority gives.
TEST(RunRounds, ThePriorityDecides) {
  std::vector<Edge> edges = random_edges(100, true);
  edges.resize(200);
  std::vector<bool> used(100, false);
  std::vector<Edge> greedy = edges, expected;
  for (std::uint32_t i = 0; i < edges.size(); ++i) edges[i].weight = greedy[i].weight = i;
  std::reverse(greedy.begin(), greedy.end());
  for (const Edge& edge : greedy) {
    if (used[edge.a] || used[edge.b]) continue;
    used[edge.a] = used[edge.b] = true;
    expected.push_back(edge);
  }
  Matching matching(100);
  run_rounds(Executor({.threads = 3}), matching, edges);
  std::sort(expected.begin(), expected.end());
  std::sort(matching.matched.begin(), matching.matched.end());
  EXPECT_EQ(matching.matched, expected);
}

/// Fifty items share each list, and every one appends itself once: one in fifty can win a round.
class TakeTurns {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  explicit TakeTurns(std::size_t n) : lists(n / 50) {}
  std::optional<Plan> plan(Vertex v) const { return v; }
  void footprint(Vertex v, auto&& visit) const { visit(v / 50); }
  std::size_t resource_count() const { return lists.size(); }
  void apply(const Plan& v, Commit<TakeTurns>&) { lists[v / 50].push_back(v); }
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::vector<Vertex>> lists;  // [resource]
};

/// The same with ranks, which differ in each list: those of a higher number go first.
class TakeRankedTurns {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr Vertex length = 150;

  explicit TakeRankedTurns(std::size_t n) : lists(n / length) {}
  std::optional<Plan> plan(Vertex v) const { return v; }
  void footprint(Vertex v, auto&& visit) const { visit(v / length); }
  std::size_t resource_count() const { return lists.size(); }
  std::uint8_t priority(Vertex v) const { return static_cast<std::uint8_t>(255 - v % length); }
  void apply(const Plan& v, Commit<TakeRankedTurns>&) { lists[v / length].push_back(v); }
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::vector<Vertex>> lists;  // [resource]
};

/// A window of so many items takes a 64th of all keys of reservations.
TEST(RunRounds, KeysOfReservationsBeginAnewWhenTheyAreUsedUp) {
  const std::size_t n = (std::size_t{1} << 18U) / TakeRankedTurns::length * TakeRankedTurns::length;
  TakeRankedTurns turns(n);
  const RoundsReport report = run_rounds(Executor({.threads = 2}), turns, all_items(n));
  EXPECT_EQ(report.rounds, std::size_t{TakeRankedTurns::length});
  for (std::size_t i = 0; i < turns.lists.size(); ++i) {
    EXPECT_TRUE(std::is_sorted(turns.lists[i].rbegin(), turns.lists[i].rend())) << i;
    EXPECT_EQ(turns.lists[i].size(), std::size_t{TakeRankedTurns::length}) << i;
  }
}

/// Sees what was prefetched when it is asked for its footprint.
class AskedForFootprints : public test::AskedAhead {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  explicit AskedForFootprints(std::size_t n) : AskedAhead(n), count_(n) {}
  void footprint(Vertex v, auto&& visit) const {
    EXPECT_TRUE(v < first || was_asked(v, 0)) << v;
    visit(v);
  }
  std::size_t resource_count() const { return count_; }
  std::optional<Plan> plan(Vertex) const { return {}; }
  void apply(const Plan&, Commit<AskedForFootprints>&) {}
  void commit(std::uint32_t, const Update&) {}

 private:
  std::size_t count_;
};

TEST(RunRounds, WhatFootprintsAreFoundInIsAskedForAhead) {
  AskedForFootprints op(1000);
  EXPECT_EQ(run_rounds(Executor({.threads = 1}), op, all_items(1000)).planned, 1000U);
}

/// Each has a resource of its own.
class AskedInEachPhase : public test::AskedEachTime {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  explicit AskedInEachPhase(std::size_t n) : AskedEachTime(n), times_(n) {}
  void footprint(Vertex v, auto&& visit) const {
    look(v, 0, footprints.at(times_[v]++));
    visit(v);
  }
  std::size_t resource_count() const { return times_.size(); }
  std::optional<Plan> plan(Vertex v) const {
    look(v, 0, plans);
    return v;
  }
  void apply(const Plan&, Commit<AskedInEachPhase>&) {}
  void commit(std::uint32_t, const Update&) {}

  mutable std::array<Looks, 2> footprints;  // to reserve, to see who won
  mutable Looks plans;

 private:
  mutable std::vector<std::uint8_t> times_;  // [item], looks at its footprint
};

TEST(RunRounds, ReservingSettlingAndPlanningAskAheadEach) {
  constexpr std::size_t n = 1000, first = test::AskedAhead::first;
  AskedInEachPhase op(n);
  EXPECT_EQ(run_rounds(Executor({.threads = 1}), op, all_items(n)).applied, n);
  for (const auto& looks : {op.footprints[0], op.footprints[1], op.plans}) {
    EXPECT_EQ(looks.all, n);
    EXPECT_GE(looks.asked_for, n - first);
  }
}

TEST(RunRounds, FewerAskWhereTooFewWin) {
  constexpr std::size_t n = 50000;
  TakeTurns all_ask(n);
  const RoundsReport wasteful = run_rounds(Executor({.threads = 2}), all_ask, all_items(n));
  std::vector<std::vector<Vertex>> first;
  for (const int threads : thread_counts) {
    TakeTurns turns(n);
    const RoundsReport report =
        run_rounds(Executor({.threads = threads}), turns, all_items(n), {.least_won = 0.5});
    EXPECT_EQ(report.applied, n);
    EXPECT_EQ(report.left, 0U);
    EXPECT_LT(10 * report.lost, wasteful.lost);
    if (first.empty()) first = turns.lists;
    EXPECT_EQ(turns.lists, first) << threads << " threads";
  }
}

}  // namespace
}  // namespace ductile::runtime::reservations_test
