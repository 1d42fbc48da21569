#include "ductile/runtime/checked_rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"

namespace ductile::runtime::checked_rounds_test {
namespace {

using Vertex = std::uint32_t;
constexpr Vertex nobody = 0xffffffffU;

std::vector<Vertex> all_items(std::size_t n) {
  std::vector<Vertex> items(n);
  std::iota(items.begin(), items.end(), 0U);
  return items;
}

/// The message of the contract rule that an operator breaks, checked to be `rule`.
template <class Op>
std::string caught(ContractRule rule, Op op, std::vector<typename Op::Item> work) {
  try {
    run_rounds_checked(Executor({.threads = 2}), op, std::move(work));
  } catch (const ContractBroken& broken) {
    EXPECT_EQ(static_cast<int>(broken.rule()), static_cast<int>(rule)) << broken.what();
    return broken.what();
  }
  ADD_FAILURE() << "nothing was caught";
  return "";
}

// ---- An operator by colours whose faults can be switched on ----

/// Lines of ten vertices. A vertex bypasses its successor if that is not the end of its line.
class Bypass {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex keeper, gone, next;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  struct Update {
    Vertex previous;
  };
  /// How far conflicts are announced and whom apply wakes; 3 and both is right.
  struct Faults {
    int reach = 3;
    bool wakes_back = true, wakes_ahead = true, wakes_itself = true;
    bool symmetric = true, in_range = true, plans_only_read = true;
    bool wakes_in_range = true;
  };
  static constexpr Vertex length = 10;

  Bypass(std::size_t n, const Faults& faults) : next(n), previous(n), gone(n), faults_(faults) {
    for (Vertex v = 0; v < n; ++v) {
      next[v] = v % length == length - 1 ? nobody : v + 1;
      previous[v] = v % length == 0 ? nobody : v - 1;
    }
  }

  std::optional<Plan> plan(Vertex v) const {
    if (!faults_.plans_only_read && v == 7 && ++plans_made % 2 == 0) return {};
    if (gone[v] || next[v] == nobody || next[next[v]] == nobody) return {};
    return Plan{v, next[v], next[next[v]]};
  }
  void conflicts(Vertex v, auto&& visit) const {
    if (gone[v]) return;
    Vertex forward = v, back = v;
    for (int step = 0; step < faults_.reach; ++step) {
      if (forward != nobody) forward = next[forward];
      if (back != nobody) back = previous[back];
      if (forward != nobody && faults_.symmetric) visit(forward);
      if (back != nobody) visit(back);
    }
    if (!faults_.in_range && v == 5) visit(static_cast<Vertex>(next.size()));
  }
  std::size_t item_count() const { return next.size(); }
  void apply(const Plan& plan, Commit<Bypass>& commit) {
    next[plan.keeper] = plan.next;
    gone[plan.gone] = 1;
    commit.defer(plan.next, {plan.keeper});
    if (faults_.wakes_itself) commit.wake(plan.keeper);
    if (!faults_.wakes_in_range) commit.wake(static_cast<Vertex>(next.size()) + 2);
    Vertex near = previous[plan.keeper];
    for (int step = 0; step < 2 && near != nobody && faults_.wakes_back;
         ++step, near = previous[near])
      commit.wake(near);
    commit.wake(plan.gone);
    // Whose plan has changed: three ahead. What the last of them bypasses may change meanwhile.
    near = plan.next;
    for (int left = 3; left > 0 && near != nobody && faults_.wakes_ahead; --left) {
      commit.wake(near);
      if (left > 1) near = next[near];
    }
  }
  void commit(std::uint32_t owner, const Update& update) { previous[owner] = update.previous; }

  std::vector<Vertex> next, previous;  // [vertex]
  std::vector<std::uint8_t> gone;      // [vertex]
  mutable int plans_made = 0;

 private:
  Faults faults_;
};

TEST(RunRoundsChecked, GivesWhatRunRoundsGives) {
  for (const int threads : {1, 2, 3, 4, 8}) {
    Bypass checked(400, {}), plain(400, {});
    const RoundsReport a = run_rounds_checked(Executor({.threads = 1}), checked, all_items(400));
    const RoundsReport b = run_rounds(Executor({.threads = threads}), plain, all_items(400));
    EXPECT_EQ(checked.next, plain.next);
    EXPECT_EQ(checked.previous, plain.previous);
    EXPECT_EQ(a.rounds, b.rounds);
    EXPECT_EQ(a.applied, b.applied);
    EXPECT_EQ(a.dropped, b.dropped);
    EXPECT_GT(a.dropped, 0U);
  }
}

TEST(RunRoundsChecked, CatchesConflictsThatReachTooShort) {
  const std::string message =
      caught(ContractRule::touches_announced, Bypass(400, {.reach = 0}), all_items(400));
  EXPECT_NE(message.find("round 1"), std::string::npos) << message;
  EXPECT_NE(message.find("did not announce"), std::string::npos) << message;
}

TEST(RunRoundsChecked, CatchesAPlanThatChangesWhileItsItemWaits) {
  const std::string message = caught(ContractRule::waiting_plan_kept,
                                     Bypass(10, {.wakes_back = false}), {Vertex{4}, Vertex{3}});
  EXPECT_NE(message.find("nobody woke"), std::string::npos) << message;
  EXPECT_NE(message.find("item 3, round 1"), std::string::npos) << message;
}

TEST(RunRoundsChecked, CatchesANewConflictOfTwoThatWait) {
  const std::vector<Vertex> work{4, 3, 7};  // 3 and 7 are four apart until 4 bypasses 5
  const std::string message = caught(ContractRule::waiting_conflicts_kept,
                                     Bypass(10, {.wakes_back = false, .wakes_ahead = false}), work);
  EXPECT_NE(message.find("item 3, round 1: it got a new conflict, with item 7"), std::string::npos)
      << message;
}

TEST(RunRoundsChecked, CatchesAForgottenWake) {
  const std::string message =
      caught(ContractRule::woken_if_plannable, Bypass(10, {.wakes_itself = false}), {Vertex{0}});
  EXPECT_EQ(message.find("operator breaks its contract: item 0, round 1: it had its turn"), 0U)
      << message;
}

TEST(RunRoundsChecked, CatchesConflictsThatAreNotMutual) {
  caught(ContractRule::conflicts_symmetric, Bypass(400, {.symmetric = false}), all_items(400));
}

TEST(RunRoundsChecked, CatchesNumbersOutOfRange) {
  const std::string message =
      caught(ContractRule::numbers_in_range, Bypass(400, {.in_range = false}), all_items(400));
  EXPECT_NE(message.find("item 5, round 1: conflicts() visits 400"), std::string::npos) << message;
}

TEST(RunRoundsChecked, CatchesAWakeOfWhatIsNoItem) {
  const std::string message =
      caught(ContractRule::numbers_in_range, Bypass(10, {.wakes_in_range = false}), {0});
  EXPECT_NE(
      message.find("item 0, round 1: while it was applied, item 12 was woken, but item_count() "
                   "is 10"),
      std::string::npos)
      << message;
}

TEST(RunRounds, RefusesToWakeWhatIsNoItem) {
  for (const int threads : {1, 3}) {
    Bypass op(400, {.wakes_in_range = false});
    EXPECT_THROW(run_rounds(Executor({.threads = threads}), op, all_items(400)), UnknownItem);
  }
}

TEST(RunRoundsChecked, CatchesWorkThatIsOutOfRangeOrTwiceThere) {
  const std::string beyond = caught(ContractRule::numbers_in_range, Bypass(10, {}), {3, 10});
  EXPECT_NE(beyond.find("item 10, round 1: it is in the work, but item_count() is 10"),
            std::string::npos)
      << beyond;
  const std::string twice = caught(ContractRule::items_once, Bypass(10, {}), {3, 5, 3});
  EXPECT_NE(twice.find("item 3, round 1: it is in the work twice, at places 0 and 2"),
            std::string::npos)
      << twice;
}

TEST(RunRoundsChecked, CatchesPlansThatDoMoreThanRead) {
  const std::string message =
      caught(ContractRule::plan_only_reads, Bypass(10, {.plans_only_read = false}), {Vertex{7}});
  EXPECT_NE(message.find("item 7"), std::string::npos) << message;
}

// ---- An operator whose conflicts stay, and whose plans depend on more than it waits for ----

/// A vertex takes the lowest number of its line's, by looking at both neighbours; conflicts never
/// change, but without `keeps_conflicts` a changed plan must be woken.
class Lower {
 public:
  using Item = Vertex;
  struct Plan {
    Vertex vertex, value;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  struct Update {};

  enum class Tells { none, woken, reconsidered };

  Lower(std::size_t n, Tells tells) : value(all_items(n)), tells_(tells) {
    for (Vertex& v : value) v = mix32(v);
  }
  std::optional<Plan> plan(Vertex v) const {
    Vertex least = value[v];
    conflicts(v, [&](Vertex u) { least = std::min(least, value[u]); });
    if (least == value[v]) return {};
    return Plan{v, least};
  }
  void conflicts(Vertex v, auto&& visit) const {
    if (v > 0) visit(v - 1);
    if (v + 1 < value.size()) visit(v + 1);
  }
  std::size_t item_count() const { return value.size(); }
  void apply(const Plan& plan, Commit<Lower>& commit) {
    value[plan.vertex] = plan.value;
    if (tells_ == Tells::woken) conflicts(plan.vertex, [&](Vertex u) { commit.wake(u); });
    if (tells_ == Tells::reconsidered)
      conflicts(plan.vertex, [&](Vertex u) { commit.reconsider(u); });
  }
  void commit(std::uint32_t, const Update&) {}

  std::vector<Vertex> value;  // [vertex]

 private:
  Tells tells_;
};

TEST(RunRoundsChecked, CatchesAStalePlanOfAWaitingItem) {
  const std::string message =
      caught(ContractRule::waiting_plan_kept, Lower(100, Lower::Tells::none), all_items(100));
  EXPECT_NE(message.find("its plan changed while it waited"), std::string::npos) << message;
  for (const auto tells : {Lower::Tells::woken, Lower::Tells::reconsidered}) {
    Lower right(100, tells);
    run_rounds_checked(Executor({.threads = 1}), right, all_items(100));
    EXPECT_EQ(std::count(right.value.begin(), right.value.end(), right.value[0]), 100);
  }
}

TEST(RunRounds, ReconsideringDropsNobody) {
  for (const int threads : {1, 2, 3, 4, 8}) {
    Lower woken(1000, Lower::Tells::woken), reconsidered(1000, Lower::Tells::reconsidered);
    const Executor executor({.threads = threads});
    const RoundsReport a = run_rounds(executor, woken, all_items(1000));
    const RoundsReport b = run_rounds(executor, reconsidered, all_items(1000));
    EXPECT_EQ(woken.value, reconsidered.value);
    EXPECT_GT(a.dropped, 0U);
    EXPECT_EQ(b.dropped, 0U);
    EXPECT_LE(b.rounds, a.rounds);
  }
}

// ---- Operators by reservation ----

struct Edge {
  Vertex a, b;
  friend auto operator<=>(const Edge&, const Edge&) = default;
  friend std::string to_string(const Edge& edge) {
    return std::to_string(edge.a) + "-" + std::to_string(edge.b);
  }
};

/// An edge between two free vertices is contracted to a new vertex.
class Matching {
 public:
  using Item = Edge;
  using Plan = Edge;
  struct Update {
    Vertex parent;
  };
  struct Faults {
    bool announces_both = true, in_range = true;
    std::uint32_t takes = 1;
  };

  Matching(std::size_t n, const Faults& faults) : parent(n, nobody), faults_(faults) {}
  std::optional<Plan> plan(const Edge& edge) const {
    if (parent[edge.a] != nobody || parent[edge.b] != nobody) return {};
    return edge;
  }
  void footprint(const Edge& edge, auto&& visit) const {
    if (parent[edge.a] != nobody || parent[edge.b] != nobody) return;
    visit(edge.a);
    if (faults_.announces_both) visit(edge.b);
    if (!faults_.in_range) visit(static_cast<Vertex>(parent.size()));
  }
  std::size_t resource_count() const { return parent.size(); }
  std::array<std::uint32_t, 1> demand(const Plan&) const { return {1}; }
  std::array<std::uint32_t, 1> grow(const std::array<std::uint32_t, 1>& total) {
    const auto first = static_cast<std::uint32_t>(parent.size());
    parent.resize(parent.size() + total[0], nobody);
    return {first};
  }
  void apply(const Plan& edge, Commit<Matching>& commit) {
    const Vertex fresh = commit.fresh();
    for (std::uint32_t more = 1; more < faults_.takes; ++more) commit.fresh();
    commit.defer(edge.a, {fresh});
    commit.defer(edge.b, {fresh});
  }
  void commit(std::uint32_t owner, const Update& update) { parent[owner] = update.parent; }

  std::vector<Vertex> parent;  // [vertex], new ones at the end

 private:
  Faults faults_;
};

std::vector<Edge> random_edges(Vertex n) {
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < 4 * n; ++i) {
    const Vertex a = mix32(2 * i) % n, b = mix32(2 * i + 1) % n;
    if (a != b) edges.push_back({a, b});
  }
  return edges;
}

TEST(RunRoundsChecked, MatchesAsRunRoundsDoes) {
  for (const int threads : {1, 2, 3, 4, 8}) {
    Matching checked(300, {}), plain(300, {});
    run_rounds_checked(Executor({.threads = 1}), checked, random_edges(300));
    run_rounds(Executor({.threads = threads}), plain, random_edges(300));
    EXPECT_EQ(checked.parent, plain.parent);
  }
}

TEST(RunRoundsChecked, CatchesAFootprintThatLeavesSomethingOut) {
  const std::string message = caught(ContractRule::touches_announced,
                                     Matching(300, {.announces_both = false}), random_edges(300));
  EXPECT_NE(message.find("footprint() did not announce"), std::string::npos) << message;
  EXPECT_NE(message.find('-'), std::string::npos) << message;
}

TEST(RunRoundsChecked, CatchesAFootprintOutOfRange) {
  caught(ContractRule::numbers_in_range, Matching(300, {.in_range = false}), random_edges(300));
}

TEST(RunRoundsChecked, CatchesMoreFreshNumbersThanDemanded) {
  const std::string message =
      caught(ContractRule::fresh_demanded, Matching(300, {.takes = 3}), random_edges(300));
  EXPECT_NE(message.find("took 3 fresh numbers of kind 0, demand() asked for 1"), std::string::npos)
      << message;
}

/// A vertex may go when the one after it has gone, which wakes it; the last may go at once. Each
/// holds all there is, so the one with the highest priority goes alone.
class Queue {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  explicit Queue(std::size_t n) : gone(n) {}
  std::optional<Plan> plan(Vertex v) const {
    const bool may_go = v + 1 == gone.size() || gone[v + 1];
    return may_go && !gone[v] ? std::optional<Plan>(v) : std::nullopt;
  }
  void footprint(Vertex v, auto&& visit) const {
    if (plan(v)) visit(0);
  }
  std::size_t resource_count() const { return 1; }
  void apply(const Plan& v, Commit<Queue>& commit) {
    gone[v] = 1;
    if (v > 0) commit.wake(v - 1);
  }
  void commit(std::uint32_t, const Update&) {}

  std::vector<std::uint8_t> gone;  // [vertex]
};

TEST(RunRoundsChecked, TakesWorkThatHasAnItemTwice) {
  Queue queue(3);
  run_rounds_checked(Executor(), queue, std::vector<Vertex>{0, 0, 1, 1, 2});
  EXPECT_EQ(queue.gone, std::vector<std::uint8_t>(3, 1));
}

/// Items write to what they do not own, which no plan shows; or defer what does not commute.
class Log {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  using Update = Vertex;
  static constexpr bool keeps_conflicts = true;

  Log(std::size_t n, bool defers) : done(n), defers_(defers) {}
  std::optional<Plan> plan(Vertex v) const {
    return done[v] ? std::nullopt : std::optional<Plan>(v);
  }
  void conflicts(Vertex, auto&&) const {}
  std::size_t item_count() const { return done.size(); }
  void apply(const Plan& v, Commit<Log>& commit) {
    done[v] = 1;
    if (defers_) {
      commit.defer(0, v);
    } else {
      log.push_back(v);
    }
  }
  void commit(std::uint32_t, const Update& v) { log.push_back(v); }
  friend bool operator==(const Log&, const Log&) = default;

  std::vector<std::uint8_t> done;  // [vertex]
  std::vector<Vertex> log;

 private:
  bool defers_;
};

/// A signal that vertices pass on, each to the next, at once or by a deferred write: who does not
/// have it yet plans nothing.
template <class Trait>
class Relay : public Trait {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  struct Manner {
    bool defers = false, announces = false;
  };

  Relay(std::size_t n, const Manner& manner) : has_it(n), passed_on(n), manner_(manner) {
    has_it[0] = 1;
  }
  std::optional<Plan> plan(Vertex v) const {
    return has_it[v] && !passed_on[v] ? std::optional<Plan>(v) : std::nullopt;
  }
  void conflicts(Vertex v, auto&& visit) const {
    if (manner_.announces && v > 0) visit(v - 1);
    if (manner_.announces && v + 1 < has_it.size()) visit(v + 1);
  }
  std::size_t item_count() const { return has_it.size(); }
  void apply(const Plan& v, Commit<Relay>& commit) {
    passed_on[v] = 1;
    if (v + 1 == has_it.size()) return;
    if (manner_.defers) {
      commit.defer(v + 1, {});
    } else {
      has_it[v + 1] = 1;
    }
    commit.wake(v + 1);
  }
  void commit(std::uint32_t owner, const Update&) { has_it[owner] = 1; }

  std::vector<std::uint8_t> has_it, passed_on;  // [vertex]

 private:
  Manner manner_;
};
struct PlannedFirst {};
struct OnItsOwn {
  static constexpr bool plans_on_its_own = true;
};

TEST(RunRoundsChecked, CatchesAPlanThatIsNotOnItsOwn) {
  const auto expect_right = [](auto relay) {
    run_rounds_checked(Executor({.threads = 1}), relay, all_items(5));
    EXPECT_EQ(relay.passed_on, std::vector<std::uint8_t>(5, 1));
  };
  for (const bool defers : {false, true}) {
    expect_right(Relay<PlannedFirst>(5, {defers, false}));
    expect_right(Relay<PlannedFirst>(5, {defers, true}));
    expect_right(Relay<OnItsOwn>(5, {defers, true}));
    const std::string message =
        caught(ContractRule::touches_announced, Relay<OnItsOwn>(5, {defers, false}), all_items(5));
    const std::string what = defers ? "it was woken by item 0" : "its plan changed when item 0";
    EXPECT_NE(message.find("item 1, round 1: " + what), std::string::npos) << message;
  }
}

TEST(RunRoundsChecked, CatchesWhatDependsOnTheOrder) {
  const std::string message = caught(ContractRule::order_free, Log(20, false), all_items(20));
  EXPECT_NE(message.find("opposite order"), std::string::npos) << message;
  caught(ContractRule::order_free, Log(20, true), all_items(20));
  Log right(20, true);
  run_rounds_checked(Executor({.threads = 1}), right, all_items(20),
                     {.order = CommitOrder::by_source});
  EXPECT_EQ(right.log, all_items(20));
}

// ---- An operator by reservation whose items are void until they are woken ----

/// A row of items, each of which may fire once the one before has.
struct Fuse {
  using Item = Vertex;
  using Plan = Vertex;
  struct Update {};

  std::optional<Plan> plan(Vertex v) const {
    if (fired[v] != 0 || (v > 0 && fired[v - 1] == 0)) return {};
    return v;
  }
  void footprint(Vertex v, auto&& visit) const {
    if (plan(v)) visit(v);
  }
  std::size_t resource_count() const { return fired.size(); }
  void apply(const Plan& v, Commit<Fuse>& commit) {
    fired[v] = 1;
    if (wakes && v + 1 < fired.size()) commit.wake(v + 1);
  }
  void commit(std::uint32_t, const Update&) {}

  bool wakes;
  std::vector<std::uint8_t> fired = std::vector<std::uint8_t>(10);
};

TEST(RunRoundsChecked, CatchesAVoidItemThatNobodyWakes) {
  const std::string message =
      caught(ContractRule::woken_if_plannable, Fuse{.wakes = false}, all_items(10));
  EXPECT_NE(message.find("item 1, round 1"), std::string::npos) << message;
  Fuse right{.wakes = true};
  run_rounds_checked(Executor({.threads = 1}), right, all_items(10));
  EXPECT_EQ(std::count(right.fired.begin(), right.fired.end(), 1), 10);
}

}  // namespace
}  // namespace ductile::runtime::checked_rounds_test
