/// @file
/// run_rounds: applies an operator to a set of items until none is left. In each round it finds
/// items that may run together, lets each of them plan, then apply its plan, then commits what was
/// deferred; phases never overlap, but in tiles (TiledOperator). Two strategies find items that may
/// run together: colouring of their conflict graph, class by class (for when most items act), and
/// reservation of what they touch by priority (for when few do). Which one an operator uses follows
/// from its members.
#pragma once

#include <utility>
#include <vector>

#include "ductile/runtime/detail/expect_operator.hpp"
#include "ductile/runtime/detail/rounds.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime {

/// Applies `op`, a ColouredOperator or a ReservingOperator, to `work`, a vector of items, and to
/// whatever it wakes, until nothing is left, or for most_rounds. A coloured operator's work has
/// each item once. With a deterministic executor the result does not depend on threads or timing,
/// provided that the operator keeps its contract. Throws what the operator throws; the operator's
/// data are then not to be used. Thread safety: one caller; runs on the executor, in a team.
template <class Op, class Work = std::vector<typename Op::Item>>
RoundsReport run_rounds(const Executor& executor, Op& op, Work work,
                        const RoundsOptions& options = {}) {
  if constexpr (detail::expect_operator<Op, Work>())
    return detail::run_all_rounds(executor, op, std::move(work), options);
}

}  // namespace ductile::runtime
