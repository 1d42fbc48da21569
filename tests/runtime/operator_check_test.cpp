#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ductile/runtime/checked_rounds.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "expect_caught.hpp"
#include "rounds_support.hpp"
#include "split_intervals.hpp"

namespace ductile::runtime::test {
namespace {

TEST(OperatorCheck, FindsEachFaultOfAnOperatorThatMakesThings) {
  struct Case {
    IntervalFaults faults;
    ContractRule rule;
  };
  for (const Case& each : {
           Case{{.writes_unreached = true}, ContractRule::touches_announced},
           Case{{.reads_unreached = true}, ContractRule::touches_announced},
           Case{{.goes_on = true}, ContractRule::gives_up_if_denied},
           Case{{.takes_too_many = true}, ContractRule::fresh_demanded},
           Case{{.out_of_range = true}, ContractRule::numbers_in_range},
           Case{{.reuses_plan = true}, ContractRule::plan_only_reads},
           Case{{.reaches_nothing = true}, ContractRule::touches_announced},
       }) {
    const SplitIntervals<2> op(40, 4e-3, each.faults);
    expect_caught(each.rule, op, op.all_items());
  }
}

TEST(OperatorCheck, LetsASoundOperatorPass) {
  for (const std::size_t count : {1, 5, 300}) {
    SplitIntervals<3> op(count, 7e-4);
    const RoundsReport report = run_rounds_checked(Executor({.threads = 2}), op, op.all_items());
    EXPECT_TRUE(op.is_whole());
    EXPECT_EQ(report.applied, op.intervals.size() - count);
  }
}

struct SumFaults {
  bool hides_next = false, is_one_sided = false, wakes = false;
};
/// Each vertex of a line takes the sum of itself and its two neighbours, once.
class Sums {
 public:
  using Item = Vertex;
  struct Plan {
    std::uint32_t sum;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  explicit Sums(SumFaults faults = {}) : value(100, 1), faults_(faults) {}

  std::size_t resource_count() const { return value.size(); }
  void conflicts(Vertex v, auto&& visit) const {
    if (v > 0) visit(v - 1);
    if (v + 1 < value.size() && !faults_.hides_next && !(faults_.is_one_sided && v == 50))
      visit(v + 1);
  }
  bool plan(Vertex v, Plan& plan, auto& reach) const {
    if (!reach(v)) return false;
    plan.sum = 0;
    for (const Vertex other : {v - 1, v, v + 1}) {
      if (other >= value.size()) continue;
      if (faults_.is_one_sided && v == 50 && other == 51) continue;
      if (!reach(other)) return false;
      plan.sum += value[other];
    }
    return true;
  }
  void apply(Vertex v, Plan& plan, auto& commit) {
    value[v] = plan.sum;
    if (faults_.wakes) commit.wake(v);
  }

  std::vector<std::uint32_t> value;

 private:
  SumFaults faults_;
};

TEST(OperatorCheck, FindsEachFaultOfAnOperatorInOrder) {
  const auto work = all_items(100);
  expect_caught(ContractRule::touches_announced, Sums({.hides_next = true}), work);
  expect_caught(ContractRule::conflicts_symmetric, Sums({.is_one_sided = true}), work);
  expect_caught(ContractRule::nobody_woken, Sums({.wakes = true}), work);
  Sums checked, run;
  run_rounds_checked(Executor({.threads = 2}), checked, work);
  run_rounds(Executor({.threads = 1}), run, work);
  EXPECT_EQ(checked.value, run.value) << "the order differs from that of the work";
}

/// Each vertex of a line adds 1 to both neighbours, once. Vertices with a common neighbour have no
/// conflict, because the order of additions does not matter unless one of them reads the sum.
class SharedSums {
 public:
  using Item = Vertex;
  struct Plan {
    std::uint32_t read;
    friend bool operator==(const Plan&, const Plan&) = default;
  };
  explicit SharedSums(bool reads) : sum_(100, 0), is_done_(100, 0), reads_(reads) {}

  std::size_t resource_count() const { return sum_.size(); }
  void conflicts(Vertex v, auto&& visit) const {
    for (const Vertex other : {v - 1, v + 1})
      if (other < sum_.size()) visit(other);
  }
  bool plan(Vertex v, Plan& plan, auto& reach) const {
    if (!reach(v)) return false;
    plan.read = 0;
    for (const Vertex other : {v - 1, v + 1}) {
      if (other >= sum_.size()) continue;
      if (!reach(other)) return false;
      if (reads_) plan.read += sum_[other];
    }
    return is_done_[v] == 0;
  }
  void apply(Vertex v, const Plan&, auto&) {
    is_done_[v] = 1;
    conflicts(v, [&](Vertex other) { ++sum_[other]; });
  }

 private:
  std::vector<std::uint32_t> sum_;
  std::vector<std::uint8_t> is_done_;
  bool reads_;
};

TEST(OperatorCheck, FindsWhoReadsWhatAnotherWithoutAConflictWrites) {
  const auto work = all_items(100);
  expect_caught(ContractRule::touches_announced, SharedSums(true), work, Strategy::tiles);
  expect_caught(ContractRule::touches_announced, SharedSums(true), work, Strategy::colours);
  SharedSums sound(false);
  EXPECT_EQ(run_rounds_checked(Executor({.threads = 2}), sound, work, {.strategy = Strategy::tiles})
                .applied,
            100U);
}

/// Each item takes the first free place from a random one on. If it reaches for places one by one,
/// the places it reaches depend on earlier items; otherwise it reaches for all it may take.
class Probing {
 public:
  using Item = Vertex;
  using Plan = Vertex;
  explicit Probing(bool reaches_ahead) : taken_by(200, 0), reaches_ahead_(reaches_ahead) {}

  std::size_t resource_count() const { return taken_by.size(); }
  bool plan(Vertex item, Vertex& place, auto& reach) const {
    const auto first = static_cast<Vertex>(mix64(item) % (taken_by.size() - most));
    for (Vertex p = first; reaches_ahead_ && p < first + most; ++p)
      if (!reach(p)) return false;
    for (place = first; place < first + most; ++place) {
      if (!reaches_ahead_ && !reach(place)) return false;
      if (taken_by[place] == 0) return true;
    }
    return false;
  }
  void apply(Vertex item, Vertex place, auto&) { taken_by[place] = item + 1; }

  std::vector<Vertex> taken_by;  // [place], 0 if it is free

 private:
  static constexpr Vertex most = 6;
  bool reaches_ahead_;
};

TEST(OperatorCheck, FindsWhatDependsOnMoreThanEarlierItems) {
  expect_caught(ContractRule::order_kept, Probing(false), all_items(150), Strategy::in_order);
  Probing checked(true), run(true);
  run_rounds_checked(Executor({.threads = 2}), checked, all_items(150),
                     {.strategy = Strategy::in_order});
  run_rounds(Executor({.threads = 1}), run, all_items(150), {.strategy = Strategy::in_order});
  EXPECT_EQ(checked.taken_by, run.taken_by);
}

/// Has a plan as long as it is not done, and forgets to wake itself.
class Countdown {
 public:
  using Item = Vertex;
  struct Plan {};
  std::vector<int> left{3, 1, 2};
  bool wakes = false;

  std::size_t resource_count() const { return left.size(); }
  bool plan(Vertex v, Plan&, auto& reach) const { return reach(v) && left[v] > 0; }
  void apply(Vertex v, Plan&, auto& commit) {
    if (--left[v] > 0 && wakes) commit.wake(v);
  }
};

TEST(OperatorCheck, FindsWhoWasNotWoken) {
  Countdown op;
  expect_caught(ContractRule::woken_if_plannable, op, all_items(3));
  // In order nothing is woken, so each counts down once.
  run_rounds_checked(Executor(), op, all_items(3), {.strategy = Strategy::in_order});
  EXPECT_EQ(op.left, (std::vector{2, 0, 1}));
  op.wakes = true;
  run_rounds_checked(Executor(), op, all_items(3));
  EXPECT_EQ(op.left, (std::vector{0, 0, 0}));
}

/// The item is invalid and would lead out of its array.
TEST(OperatorCheck, NamesTheItemThatReachesForWhatIsNot) {
  Countdown op;
  try {
    run_rounds_checked(Executor(), op, {0, 4000000000U});
    ADD_FAILURE() << "expected ContractBroken, nothing was thrown";
  } catch (const ContractBroken& broken) {
    EXPECT_EQ(broken.item(), "4000000000");
    EXPECT_EQ(broken.rule(), ContractRule::numbers_in_range);
  }
}

}  // namespace
}  // namespace ductile::runtime::test
