#include "ductile/runtime/run_rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include "rounds_support.hpp"

namespace ductile::runtime::run_rounds_test {
namespace {

using test::all_items;
using test::thread_counts;
using test::Vertex;

// ---- Maximal independent set: by colours, nothing is deferred that does not commute ----

/// A ring of vertices with chords. A vertex joins the set unless a neighbour has; it tells its
/// neighbours by deferred writes.
class IndependentSet {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr bool keeps_conflicts = true;

  explicit IndependentSet(std::size_t n) : member(n), barred(n) {}

  std::optional<Plan> plan(Vertex v) const {
    if (member[v] || barred[v]) return {};
    return v;
  }
  void conflicts(Vertex v, auto&& visit) const {
    const auto n = static_cast<Vertex>(member.size());
    for (const Vertex step : {1U, 7U, n - 1, n - 7}) visit((v + step) % n);
  }
  std::size_t item_count() const { return member.size(); }
  void apply(const Plan& v, Commit<IndependentSet>& commit) {
    member[v] = 1;
    conflicts(v, [&](Vertex other) { commit.defer(other, {}); });
  }
  void commit(std::uint32_t owner, const Update&) { barred[owner] = 1; }

  std::vector<std::uint8_t> member, barred;  // [vertex]
};

void expect_maximal_independent(const IndependentSet& set) {
  for (Vertex v = 0; v < set.member.size(); ++v) {
    int members_beside = 0;
    set.conflicts(v, [&](Vertex other) { members_beside += set.member[other]; });
    EXPECT_EQ(set.member[v] != 0, members_beside == 0) << "vertex " << v;
  }
}

TEST(RunRounds, FindsAMaximalIndependentSetByColours) {
  std::vector<std::uint8_t> first;
  for (const int threads : thread_counts) {
    IndependentSet set(5000);
    const Executor executor({.threads = threads});
    const RoundsReport report = run_rounds(executor, set, all_items(5000));
    expect_maximal_independent(set);
    EXPECT_EQ(report.rounds, 1U);
    EXPECT_EQ(report.planned, 5000U);
    EXPECT_EQ(report.left, 0U);
    if (first.empty()) first = set.member;
    EXPECT_EQ(set.member, first) << threads << " threads";
  }
}

TEST(RunRounds, FindsAMaximalIndependentSetInArrivalOrder) {
  for (int run = 0; run < 5; ++run) {
    IndependentSet set(5000);
    run_rounds(Executor({.threads = 4, .deterministic = false}), set, all_items(5000));
    expect_maximal_independent(set);
  }
}

// ---- Labels that flow through a graph that is rewired meanwhile ----

/// Vertices on lines of ten. A vertex bypasses its successor if that is not the end of its line, so
/// that in the end every line is its first and its last vertex. Applying joins vertices that were
/// not neighbours: a colouring is stale at once, and whoever is woken must leave the round.
template <class Trait>
class BypassWith : public Trait {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex keeper, gone, next;
  };
  struct Update {
    Vertex previous;
  };
  static constexpr Vertex length = 10, nobody = 0xffffffffU;

  explicit BypassWith(std::size_t n) : next(n), previous(n), gone(n) {
    for (Vertex v = 0; v < n; ++v) {
      next[v] = v % length == length - 1 ? nobody : v + 1;
      previous[v] = v % length == 0 ? nobody : v - 1;
    }
  }

  std::optional<Plan> plan(Vertex v) const {
    if (gone[v] || next[v] == nobody || next[next[v]] == nobody) return {};
    return Plan{v, next[v], next[next[v]]};
  }
  /// Three vertices apart at most: what is read or changed for one, and whom it wakes.
  void conflicts(Vertex v, auto&& visit) const {
    if (gone[v]) return;
    Vertex forward = v, back = v;
    for (int step = 0; step < 3; ++step) {
      if (forward != nobody) forward = next[forward];
      if (back != nobody) back = previous[back];
      if (forward != nobody) visit(forward);
      if (back != nobody) visit(back);
    }
  }
  std::size_t item_count() const { return next.size(); }
  void apply(const Plan& plan, Commit<BypassWith>& commit) {
    if (gone[plan.keeper] || next[plan.keeper] != plan.gone || next[plan.gone] != plan.next)
      stale = true;
    next[plan.keeper] = plan.next;
    gone[plan.gone] = 1;
    commit.defer(plan.next, {plan.keeper});
    Vertex near = plan.keeper;
    for (int step = 0; step < 3 && near != nobody; ++step, near = previous[near]) commit.wake(near);
    near = plan.next;
    for (int step = 0; step < 2 && near != nobody; ++step, near = next[near]) commit.wake(near);
  }
  void commit(std::uint32_t owner, const Update& update) { previous[owner] = update.previous; }

  std::vector<Vertex> next, previous;  // [vertex]
  std::vector<std::uint8_t> gone;      // [vertex]
  bool stale = false;                  // a plan was applied to what it was not made for
};

struct PlannedFirst {};
struct OnItsOwn {
  static constexpr bool plans_on_its_own = true;
};
using Bypass = BypassWith<PlannedFirst>;
using ImmediateBypass = BypassWith<OnItsOwn>;
static_assert(!ImmediateOperator<Bypass> && ImmediateOperator<ImmediateBypass>);

void expect_all_bypassed(const auto& lines) {
  EXPECT_FALSE(lines.stale);
  for (Vertex v = 0; v < lines.next.size(); v += Bypass::length) {
    const Vertex end = v + Bypass::length - 1;
    EXPECT_EQ(lines.next[v], end);
    EXPECT_EQ(lines.previous[end], v);
  }
}

TEST(RunRounds, WhoIsWokenLeavesTheRound) {
  std::size_t rounds = 0, applied = 0;
  for (const int threads : thread_counts) {
    Bypass lines(20000);
    const RoundsReport report = run_rounds(Executor({.threads = threads}), lines, all_items(20000));
    expect_all_bypassed(lines);
    EXPECT_EQ(report.applied, 2000U * (Bypass::length - 2));
    EXPECT_GT(report.rounds, 1U);
    if (rounds == 0) rounds = report.rounds, applied = report.planned;
    EXPECT_EQ(report.rounds, rounds) << threads << " threads";
    EXPECT_EQ(report.planned, applied) << threads << " threads";
  }
}

TEST(RunRounds, ItMakesNoDifferenceWhetherItemsAreAppliedAtOnce) {
  for (const std::size_t window : {1, 37, 2000, 0}) {
    SCOPED_TRACE(window);
    const RoundsOptions options{.window = window};
    Bypass planned_first(20000);
    const RoundsReport expected =
        run_rounds(Executor({.threads = 2}), planned_first, all_items(20000), options);
    for (const int threads : thread_counts) {
      ImmediateBypass lines(20000);
      const RoundsReport report =
          run_rounds(Executor({.threads = threads}), lines, all_items(20000), options);
      expect_all_bypassed(lines);
      EXPECT_EQ(lines.previous, planned_first.previous);
      EXPECT_EQ(report.rounds, expected.rounds);
      EXPECT_EQ(report.planned, expected.planned);
      EXPECT_EQ(report.dropped, expected.dropped);
      EXPECT_EQ(report.applied, expected.applied);
      EXPECT_EQ(report.committed, expected.committed);
    }
  }
}

TEST(RunRounds, WindowsDoNotChangeWhatIsReached) {
  for (const std::size_t window : {1, 37, 1000, 2000, 0}) {
    SCOPED_TRACE(window);
    const RoundsOptions options{.window = window};
    IndependentSet set(5000);
    const RoundsReport report = run_rounds(Executor({.threads = 3}), set, all_items(5000), options);
    expect_maximal_independent(set);
    EXPECT_EQ(report.planned, 5000U);
    std::vector<Vertex> first;
    for (const int threads : thread_counts) {
      Bypass lines(20000);
      run_rounds(Executor({.threads = threads}), lines, all_items(20000), options);
      expect_all_bypassed(lines);
      if (first.empty()) first = lines.previous;
      EXPECT_EQ(lines.previous, first) << threads << " threads";
    }
  }
}

/// Items that neither conflict nor act: a window is one batch.
struct Idle {
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  std::optional<Plan> plan(Vertex) const { return {}; }
  void conflicts(Vertex, auto&&) const {}
  std::size_t item_count() const { return 100000; }
  void apply(const Plan&, Commit<Idle>&) {}
  void commit(std::uint32_t, const Update&) {}
};

TEST(RunRounds, WindowsAreNoLargerThanAsked) {
  const auto windows = [](std::size_t items, std::size_t window) {
    Idle idle;
    return run_rounds(Executor({.threads = 2}), idle, all_items(items), {.window = window}).batches;
  };
  EXPECT_EQ(windows(1, 1000), 1U);
  EXPECT_EQ(windows(1000, 1000), 1U);
  EXPECT_EQ(windows(1001, 1000), 2U);
  EXPECT_EQ(windows(100000, 1000), 100U);
  EXPECT_EQ(windows(100000, 0), 1U);
}

TEST(RunRounds, StaleColoursDoNoHarmInArrivalOrder) {
  for (int run = 0; run < 5; ++run) {
    Bypass lines(20000);
    run_rounds(Executor({.threads = 4, .deterministic = false}), lines, all_items(20000));
    expect_all_bypassed(lines);
  }
}

TEST(RunRounds, StopsAfterTheMostRoundsAllowed) {
  Bypass lines(20000);
  const RoundsReport report =
      run_rounds(Executor({.threads = 2}), lines, all_items(20000), {.most_rounds = 1});
  EXPECT_EQ(report.rounds, 1U);
  EXPECT_GT(report.left, 0U);
}

/// An item wakes itself until it has been applied so many times.
struct Countdown {
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  std::size_t left;

  std::optional<Plan> plan(Vertex v) const {
    return left > 0 ? std::optional<Plan>(v) : std::nullopt;
  }
  void footprint(Vertex v, auto&& visit) const {
    if (left > 0) visit(v);
  }
  std::size_t resource_count() const { return 1; }
  void apply(const Plan& v, Commit<Countdown>& commit) {
    --left;
    commit.wake(v);
  }
  void commit(std::uint32_t, const Update&) {}
};

TEST(RunRounds, GoesOnUntilNothingIsLeft) {
  Countdown countdown{3000};
  const RoundsReport report = run_rounds(Executor({.threads = 2}), countdown, all_items(1));
  EXPECT_EQ(report.applied, 3000U);
  EXPECT_EQ(report.left, 0U);
}

// ---- Order of commits, and what goes wrong ----

/// Every item appends itself to one common list, which keeps the order.
class Append {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  using Update = Vertex;
  static constexpr bool keeps_conflicts = true;

  explicit Append(std::size_t n) : size_(n) {}
  std::optional<Plan> plan(Vertex v) const {
    if (v == throws_in_plan) throw std::runtime_error("plan");
    return v;
  }
  void conflicts(Vertex, auto&&) const {}
  std::size_t item_count() const { return size_; }
  void apply(const Plan& v, Commit<Append>& commit) {
    if (v == throws_in_apply) throw std::runtime_error("apply");
    commit.defer(v % 3, v);
  }
  void commit(std::uint32_t owner, const Update& v) {
    if (v == throws_in_commit) throw std::runtime_error("commit");
    lists[owner].push_back(v);
  }

  std::array<std::vector<Vertex>, 3> lists;
  Vertex throws_in_plan = ~0U, throws_in_apply = ~0U, throws_in_commit = ~0U;

 private:
  std::size_t size_;
};

TEST(RunRounds, CommitsInTheOrderOfSourcesIfAsked) {
  for (const int threads : thread_counts) {
    Append append(10000);
    run_rounds(Executor({.threads = threads}), append, all_items(10000),
               {.order = CommitOrder::by_source});
    for (const auto& list : append.lists) {
      EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
      EXPECT_NEAR(static_cast<double>(list.size()), 3333, 1);
    }
  }
}

TEST(RunRounds, PassesOnWhatAnOperatorThrows) {
  const auto message = [](Append& append) -> std::string {
    try {
      run_rounds(Executor({.threads = 4}), append, all_items(10000));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  Append plan(10000), apply(10000), commit(10000);
  plan.throws_in_plan = apply.throws_in_apply = commit.throws_in_commit = 6789;
  EXPECT_EQ(message(plan), "plan");
  EXPECT_EQ(message(apply), "apply");
  EXPECT_EQ(message(commit), "commit");
}

/// Counts down from each item's number, on a counter that many share. Items, plans and updates can
/// only be moved; plans and updates are large.
class CountDown {
 public:
  struct Item {
    std::unique_ptr<std::uint32_t> number;
    bool operator<(const Item& other) const { return *number < *other.number; }
  };
  struct alignas(128) Large {
    std::unique_ptr<std::uint32_t> number;
    std::array<std::uint32_t, 1024> copies;
  };
  using Plan = Large;
  using Update = Large;
  static constexpr std::uint32_t counters = 50, steps = 4;

  static Large large(std::uint32_t number) {
    Large made{std::make_unique<std::uint32_t>(number), {}};
    made.copies.fill(number);
    return made;
  }

  std::optional<Plan> plan(const Item& item) const { return large(*item.number); }
  void footprint(const Item& item, auto&& visit) const { visit(*item.number / steps % counters); }
  std::size_t resource_count() const { return counters; }
  void apply(const Plan& plan, Commit<CountDown>& commit) {
    const std::uint32_t number = *plan.number;
    commit.defer(number / steps % counters, large(number));
    if (number % steps > 0) commit.wake({std::make_unique<std::uint32_t>(number - 1)});
  }
  void commit(std::uint32_t counter, Update&& update) {
    for (const std::uint32_t copy : update.copies) whole = whole && copy == *update.number;
    passed[counter].push_back(std::move(update.number));
  }

  std::atomic<bool> whole = true;
  std::array<std::vector<std::unique_ptr<std::uint32_t>>, counters> passed;
};

TEST(RunRounds, MovesWhatCanOnlyBeMoved) {
  constexpr std::uint32_t starts = 600;
  std::vector<std::vector<std::uint32_t>> first;
  for (int threads : {1, 2, 3, 8}) {
    std::vector<CountDown::Item> work;
    for (std::uint32_t i = 0; i < starts; ++i)
      work.push_back(
          {std::make_unique<std::uint32_t>(i * CountDown::steps + CountDown::steps - 1)});
    CountDown count;
    const auto report = run_rounds(Executor({.threads = threads}), count, std::move(work));
    EXPECT_EQ(report.left, 0U);
    EXPECT_TRUE(count.whole);
    std::vector<std::vector<std::uint32_t>> got(CountDown::counters);
    std::set<std::uint32_t> all;
    for (std::uint32_t c = 0; c < CountDown::counters; ++c)
      for (const auto& number : count.passed[c]) got[c].push_back(*number), all.insert(*number);
    EXPECT_EQ(all.size(), starts * CountDown::steps);
    EXPECT_EQ(*all.rbegin(), starts * CountDown::steps - 1);
    if (first.empty()) first = got;
    EXPECT_EQ(got, first) << threads;
  }
}

// ---- What an operator prefetches ----

class AskedForConflicts : public test::AskedAhead {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr bool keeps_conflicts = true;

  explicit AskedForConflicts(std::size_t n) : AskedAhead(n), count_(n) {}
  void conflicts(Vertex v, auto&& visit) const {
    EXPECT_TRUE(v < first || v + first > count_ || was_asked(v, 1)) << v;  // not the last
    visit((v + 1) % static_cast<Vertex>(count_));
  }
  std::size_t item_count() const { return count_; }
  std::optional<Plan> plan(Vertex) const { return {}; }
  void apply(const Plan&, Commit<AskedForConflicts>&) {}
  void commit(std::uint32_t, const Update&) {}

 private:
  std::size_t count_;
};

TEST(RunRounds, WhatConflictsAreFoundInIsAskedForAhead) {
  AskedForConflicts op(100);  // so few are coloured in their order
  EXPECT_EQ(run_rounds(Executor({.threads = 1}), op, all_items(100)).planned, 100U);
}

/// The first class wakes all others of a ring, which so leave the round.
class WakesNeighbours {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  explicit WakesNeighbours(std::size_t n) : count_(n), planned_(n) {}
  void conflicts(Vertex v, auto&& visit) const {
    visit(after(v));
    visit((v + static_cast<Vertex>(count_) - 1) % static_cast<Vertex>(count_));
  }
  std::size_t item_count() const { return count_; }
  void prefetch(Vertex, int stage) const { asked_ += stage == 0; }
  std::optional<Plan> plan(Vertex v) const {
    if (std::exchange(planned_[v], true)) return {};
    return v;
  }
  void apply(const Plan& v, Commit<WakesNeighbours>& commit) {
    conflicts(v, [&](Vertex other) { commit.wake(other); });
  }
  void commit(std::uint32_t, const Update&) {}
  std::size_t asked() const { return asked_; }

 private:
  Vertex after(Vertex v) const { return (v + 1) % static_cast<Vertex>(count_); }

  std::size_t count_;
  mutable std::vector<std::uint8_t> planned_;  // [item]
  mutable std::size_t asked_ = 0;
};

TEST(RunRounds, WhoLeftTheRoundIsNotAskedFor) {
  WakesNeighbours op(1000);
  const RoundsReport report = run_rounds(Executor({.threads = 1}), op, all_items(1000));
  EXPECT_EQ(report.applied, 1000U);
  EXPECT_GT(report.dropped, 100U);
  EXPECT_GT(op.asked(), report.planned / 2);
  EXPECT_LE(op.asked(), report.planned);
}

/// Items conflict in pairs, so that blocks that are coloured side by side do not.
class AskedForPairs : public test::AskedEachTime {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};
  static constexpr bool keeps_conflicts = true;

  explicit AskedForPairs(std::size_t n) : AskedEachTime(n), count_(n) {}
  void conflicts(Vertex v, auto&& visit) const {
    look(v, 1, conflicts_seen);
    visit(v ^ 1U);
  }
  std::size_t item_count() const { return count_; }
  std::optional<Plan> plan(Vertex v) const {
    look(v, 0, plans);
    return v;
  }
  void apply(const Plan&, Commit<AskedForPairs>&) {}
  void commit(std::uint32_t, const Update&) {}

  mutable Looks conflicts_seen, plans;

 private:
  std::size_t count_;
};

TEST(RunRounds, ColouringInBlocksAndPlanningAskAhead) {
  constexpr std::size_t n = 8192;  // coloured in blocks, of which the first items are not asked for
  AskedForPairs op(n);
  EXPECT_EQ(run_rounds(Executor({.threads = 1}), op, all_items(n), {.window = n}).applied, n);
  EXPECT_EQ(op.conflicts_seen.all, n);
  EXPECT_GE(op.conflicts_seen.asked_for, n / 2);
  EXPECT_EQ(op.plans.all, n);
  EXPECT_GE(op.plans.asked_for, n - 2 * AskedForConflicts::first);  // two classes
}

TEST(RunRounds, NoWorkIsNoRound) {
  Append append(10);
  const RoundsReport report = run_rounds(Executor({.threads = 2}), append, {});
  EXPECT_EQ(report.rounds, 0U);
  EXPECT_EQ(report.planned, 0U);
}

}  // namespace
}  // namespace ductile::runtime::run_rounds_test
