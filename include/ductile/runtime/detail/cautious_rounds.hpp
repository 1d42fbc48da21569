/// @file
/// run_cautious_rounds: which strategy runs a CautiousOperator.
#pragma once

// The headers of the strategies:
//
//   region_rounds          regions; region_map says whose a resource is
//   ordered_stream         in_order, of operators that tell conflicts
//   ordered_windows        in_order, of all other operators
//   reservation_windows    reservations
//   lock_rounds            locks
//     made_things          the numbers of what operators make, by numbers

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/cautious_operator.hpp"
#include "ductile/runtime/detail/lock_rounds.hpp"
#include "ductile/runtime/detail/ordered_stream.hpp"
#include "ductile/runtime/detail/ordered_windows.hpp"
#include "ductile/runtime/detail/reach.hpp"
#include "ductile/runtime/detail/region_rounds.hpp"
#include "ductile/runtime/detail/reservation_windows.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/rounds_report.hpp"
#include "ductile/runtime/team.hpp"

namespace ductile::runtime::detail {

/// Says at compile time where an optional member is there but cannot be used.
template <CautiousOperator Op>
constexpr void expect_whole_members() {
  constexpr bool makes_things = requires { &Op::demand; }
  || requires { &Op::counts; }
  || requires { &Op::grow; };
  static_assert(!makes_things || GrowingCautiousOperator<Op>,
                "an operator that makes things has demand(const Plan&) const, counts() const, "
                "grow(room) and renumber(kind, std::span<const Renumbered>, count), of arrays of "
                "one size");
  constexpr bool has_places = requires { &Op::place_of; };
  static_assert(!has_places || PlacedOperator<Op>,
                "place_of(std::uint32_t) const returns std::array<double, 2> or of 3");
}

/// The strategy that options and operator ask for. Throws std::invalid_argument if the operator
/// lacks what it needs.
template <CautiousOperator Op>
Strategy strategy_of(const Executor& executor, const RoundsOptions& options) {
  switch (options.strategy) {
    case Strategy::regions:
      if (!PlacedOperator<Op>)
        throw std::invalid_argument(
            "strategy regions: the operator has no member place_of(resource) const that returns "
            "std::array<double, 2> or std::array<double, 3>");
      break;
    case Strategy::in_order:
      if (kinds_made < Op >> 0)
        throw std::invalid_argument(
            "strategy in_order: the operator makes things, whose numbers follow another order");
      break;
    case Strategy::locks:
      if (executor.deterministic())
        throw std::invalid_argument(
            "strategy locks: the executor is deterministic, see ExecutorOptions");
      break;
    case Strategy::reservations:
      break;
    case Strategy::automatic:
      if (!executor.deterministic()) return Strategy::locks;
      if (PlacedOperator<Op>) return Strategy::regions;
      return ConflictingOperator<Op> ? Strategy::in_order : Strategy::reservations;
  }
  return options.strategy;
}

/// For the strategy in_order: nobody may be woken.
template <class Item>
struct OrderedCommit {
  void wake(const Item&) const {
    throw std::logic_error(
        "strategy in_order: an item was woken, but only the work itself has an order");
  }
};

/// Work has size() and items by [i]. applied(item) is told of each that was applied, in the
/// order of the work.
template <CautiousOperator Op, class Work>
RoundsReport run_in_order(const Executor& executor, Op& op, const Work& work, auto&& applied) {
  constexpr std::size_t few_items = 2048;
  OrderedCommit<typename Op::Item> commit;
  const auto apply = [&](const typename Op::Item& item, typename Op::Plan& plan) {
    op.apply(item, plan, commit);
  };
  if (executor.threads() > 1 && work.size() >= few_items) {
    if constexpr (ConflictingOperator<Op>) {
      OrderedStream<Op, Work> stream(executor, op, work);
      if (!stream.is_chain()) return stream.run(apply, applied);
    } else {
      return OrderedWindows<Op, Work>(executor, op, work).run(apply, applied);
    }
  }
  RoundsReport report{.rounds = 1, .planned = work.size()};
  typename Op::Plan plan{};
  ReachAll reach;
  for (std::size_t i = 0; i < work.size(); ++i) {
    const typename Op::Item item = work[i];
    if (!op.plan(item, plan, reach)) continue;
    apply(item, plan);
    applied(item);
    ++report.applied;
  }
  return report;
}

template <class Item>
std::vector<Item> to_vector(std::vector<Item> work) {
  return work;
}
template <class Item>
std::vector<Item> to_vector(const auto& work) {
  std::vector<Item> items;
  items.reserve(work.size());
  for (std::size_t i = 0; i < work.size(); ++i) items.push_back(work[i]);
  return items;
}

/// Work has size() and items by [i].
template <CautiousOperator Op, class Work>
RoundsReport run_cautious_rounds(const Executor& executor, Op& op, Work work,
                                 const RoundsOptions& options) {
  using Item = typename Op::Item;
  expect_whole_members<Op>();
  const Strategy strategy = strategy_of<Op>(executor, options);
  const auto most_rounds = static_cast<std::size_t>(options.most_rounds);
  return with_team(executor, [&] {
    if constexpr (PlacedOperator<Op>)
      if (strategy == Strategy::regions)
        return RegionRounds<Op>(executor, op).run(to_vector<Item>(std::move(work)), most_rounds);
    if constexpr (kinds_made<Op> == 0)
      if (strategy == Strategy::in_order) return run_in_order(executor, op, work, TellNobody());
    if (strategy == Strategy::locks)
      return LockRounds<Op>(executor, op).run(to_vector<Item>(std::move(work)), most_rounds);
    return ReservationWindows<Op>(executor, op)
        .run_spread(to_vector<Item>(std::move(work)), most_rounds);
  });
}

}  // namespace ductile::runtime::detail
