/// @file
/// run_cautious_rounds: which strategy runs a CautiousOperator.
#pragma once

// The headers of the strategies:
//
//   region_rounds          regions; region_map says whose a resource is
//   ordered_run            in_order: a plain loop, or
//     ordered_stream       operators that tell conflicts
//     ordered_windows      all others
//   reservation_windows    reservations, or
//     level_rounds         operators with levels
//   lock_rounds            locks
// made_things has the numbers of what operators make.

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/cautious_operator.hpp"
#include "ductile/runtime/detail/level_rounds.hpp"
#include "ductile/runtime/detail/lock_rounds.hpp"
#include "ductile/runtime/detail/ordered_run.hpp"
#include "ductile/runtime/detail/region_rounds.hpp"
#include "ductile/runtime/detail/reservation_windows.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/rounds_report.hpp"
#include "ductile/runtime/team.hpp"

namespace ductile::runtime::detail {

/// Operators of the older contract have a type Update.
template <class Op>
concept LooksCautious = requires {
  typename Op::Item;
  typename Op::Plan;
  &Op::resource_count;
}
&&!requires { typename Op::Update; };

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
  constexpr bool has_levels = requires { &Op::level; };
  static_assert(!has_levels || LevelledOperator<Op>,
                "level(const Item&) const returns std::uint32_t");
  static_assert(!has_levels || !makes_things, "an operator with levels makes no things");
}

/// Whether it is a cautious operator. Says at compile time what one lacks.
template <class Op>
constexpr bool expect_cautious() {
  static_assert(CautiousOperator<Op> || !LooksCautious<Op>,
                "a cautious operator has bool plan(const Item&, Plan&, auto& reach) const, "
                "apply(const Item&, Plan&, auto& commit) and resource_count() const");
  if constexpr (CautiousOperator<Op>) expect_whole_members<Op>();
  return CautiousOperator<Op>;
}

/// The strategy that options and operator ask for. Throws std::invalid_argument if the operator
/// lacks what it needs.
template <CautiousOperator Op>
Strategy strategy_of(const Executor& executor, const RoundsOptions& options) {
  if constexpr (LevelledOperator<Op>) {
    if (options.strategy == Strategy::automatic || options.strategy == Strategy::reservations)
      return Strategy::reservations;
    throw std::invalid_argument(
        "the operator has levels, which only the strategies automatic and reservations keep");
  }
  switch (options.strategy) {
    case Strategy::regions:
      if (!PlacedOperator<Op>)
        throw std::invalid_argument(
            "strategy regions: the operator has no member place_of(resource) const that returns "
            "std::array<double, 2> or std::array<double, 3>");
      break;
    case Strategy::in_order:
      if (kinds_made<Op> != 0)
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
  const Strategy strategy = strategy_of<Op>(executor, options);
  const auto most_rounds = static_cast<std::size_t>(options.most_rounds);
  return with_team(executor, [&] {
    if constexpr (LevelledOperator<Op>)
      return LevelRounds<Op>(executor, op).run(to_vector<Item>(std::move(work)), most_rounds);
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
