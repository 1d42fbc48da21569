/// @file
/// run_by_options: chooses the strategy for an Operator and runs it.
#pragma once

// Headers of the strategies:
//
//   region_rounds          regions; region_map gives the region of a resource
//   reservation_rounds     reservations, or
//     level_rounds         operators with levels
//   ordered_run            in_order, and within a level: a plain loop or windows
//   reservation_windows    windows of these three
//   tile_rounds            tiles; ranked_blocks runs them in order
//   colour_rounds          colours
// made_things holds the numbers of things that operators make.

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/colour_rounds.hpp"
#include "ductile/runtime/detail/level_rounds.hpp"
#include "ductile/runtime/detail/ordered_run.hpp"
#include "ductile/runtime/detail/region_rounds.hpp"
#include "ductile/runtime/detail/reservation_rounds.hpp"
#include "ductile/runtime/detail/tile_rounds.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime::detail {

/// Reports at compile time what an operator lacks, and optional members that cannot be used.
template <class Op>
constexpr void expect_whole_operator() {
  static_assert(Operator<Op>,
                "an operator has bool plan(const Item&, Plan&, auto& reach) const, "
                "apply(const Item&, Plan&, auto& commit) and resource_count() const");
  constexpr bool makes_things = requires { &Op::demand; }
  || requires { &Op::counts; }
  || requires { &Op::grow; };
  static_assert(!makes_things || GrowingOperator<Op>,
                "an operator that makes things has demand(const Plan&) const, counts() const, "
                "grow(room) and renumber(kind, std::span<const Renumbered>, count), of arrays of "
                "one size");
  constexpr bool has_places = requires { &Op::place_of; };
  static_assert(!has_places || PlacedOperator<Op>,
                "place_of(std::uint32_t) const returns std::array<double, 2> or of 3");
  constexpr bool has_priority = requires { &Op::priority; };
  static_assert(!has_priority || RankedOperator<Op>,
                "priority(const Item&) const returns std::uint32_t");
  constexpr bool has_levels = requires { &Op::level; };
  static_assert(!has_levels || LevelledOperator<Op>,
                "level(const Item&) const returns std::uint32_t");
  constexpr bool defers = requires { &Op::commit; };
  static_assert(
      !defers || DeferringOperator<Op>,
      "an operator that defers has conflicts(item, visit) const, and its commit() returns "
      "how many updates there were");
  static_assert(!has_levels || !makes_things, "an operator with levels makes no things");
}

/// Throws std::invalid_argument if the operator lacks what the strategy needs.
template <Operator Op>
void expect_possible(Strategy strategy) {
  constexpr bool makes_things = kinds_made<Op> != 0;
  const auto expect = [&](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
  };
  switch (strategy) {
    case Strategy::in_order:
      return expect(!makes_things,
                    "strategy in_order: the operator makes things, whose numbers follow another "
                    "order");
    case Strategy::tiles:
      return expect(ConflictingOperator<Op> && !makes_things,
                    "strategy tiles: the operator has no member conflicts(item, visit) const, or "
                    "it makes things");
    case Strategy::colours:
      return expect(ConflictingOperator<Op>,
                    "strategy colours: the operator has no member conflicts(item, visit) const");
    case Strategy::regions:
    case Strategy::reservations:
    case Strategy::automatic:
      return;
  }
}

/// The strategy for these options and this operator. Throws as expect_possible().
template <Operator Op>
Strategy strategy_of(const RoundsOptions& options) {
  if constexpr (LevelledOperator<Op>) {
    if (options.strategy == Strategy::automatic || options.strategy == Strategy::reservations)
      return Strategy::reservations;
    throw std::invalid_argument(
        "the operator has levels, which only the strategies automatic and reservations keep");
  }
  expect_possible<Op>(options.strategy);
  if (options.strategy != Strategy::automatic) return options.strategy;
  constexpr bool has_order = ConflictingOperator<Op> && !PlacedOperator<Op> && kinds_made<Op> == 0;
  return has_order ? Strategy::in_order : Strategy::regions;
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

/// Runs a possible strategy. Work has size() and operator[].
template <Strategy S, Operator Op, class Work>
RoundsReport run_by(const Executor& executor, Op& op, Work work, std::size_t most_rounds) {
  using Item = typename Op::Item;
  const auto items = [&] { return to_vector<Item>(std::move(work)); };
  if constexpr (S == Strategy::regions)
    return RegionRounds<Op>(executor, op).run(items(), most_rounds);
  if constexpr (S == Strategy::in_order) return run_in_order(executor, op, work, TellNobody());
  if constexpr (S == Strategy::reservations && LevelledOperator<Op>)
    return run_by_level(executor, op, items(), most_rounds);
  if constexpr (S == Strategy::reservations && !LevelledOperator<Op>)
    return ReservationRounds<Op>(executor, op).run(items(), most_rounds);
  if constexpr (S == Strategy::tiles) return TileRounds<Op>(executor, op).run(work, most_rounds);
  if constexpr (S == Strategy::colours)
    return ColourRounds<Op>(executor, op).run(work, most_rounds);
}

template <Operator Op, class Work>
RoundsReport run_by_options(const Executor& executor, Op& op, Work work,
                            const RoundsOptions& options) {
  const Strategy strategy = strategy_of<Op>(options);
  const auto most_rounds = static_cast<std::size_t>(options.most_rounds);
  const auto run = [&]<Strategy S>() {
    return run_by<S>(executor, op, std::move(work), most_rounds);
  };
  return with_team(executor, [&] {
    if constexpr (LevelledOperator<Op>) return run.template operator()<Strategy::reservations>();
    if (strategy == Strategy::regions) return run.template operator()<Strategy::regions>();
    if constexpr (kinds_made<Op> == 0)
      if (strategy == Strategy::in_order) return run.template operator()<Strategy::in_order>();
    if constexpr (ConflictingOperator<Op> && kinds_made<Op> == 0)
      if (strategy == Strategy::tiles) return run.template operator()<Strategy::tiles>();
    if constexpr (ConflictingOperator<Op>)
      if (strategy == Strategy::colours) return run.template operator()<Strategy::colours>();
    return run.template operator()<Strategy::reservations>();
  });
}

}  // namespace ductile::runtime::detail
