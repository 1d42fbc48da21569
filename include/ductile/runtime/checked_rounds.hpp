/// @file
/// run_rounds_checked: run_rounds for authors of operators: slow, on one thread, and throws
/// ContractBroken as soon as the operator does something that would be wrong, or would depend on
/// timing, on many. It sees where items that have reached for nothing in common, or in `tiles` and
/// `colours` have no conflict, change each other's plans, and whether plan() gives up where it
/// should; not single reads and writes. The more an operator tells, the more it sees:
///   Plan has ==            compares plans, not only whether there is one
///   to_string(Item)        messages name the item, not only its place (numbers name themselves)
/// Where items lower what others have not reached for, as LevelledOperator allows, the operator has
/// a member `lowers_minima`: then another item may lose its plan.
/// An operator that on purpose does not wake all items that could plan again has a member
/// `forgoes_wakes`.
#pragma once

#include <utility>
#include <vector>

#include "ductile/runtime/detail/contract.hpp"
#include "ductile/runtime/detail/operator_check.hpp"
#include "ductile/runtime/detail/strategies.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime {

/// As run_rounds(), for items that can be copied; most_rounds is not heeded. Throws ContractBroken,
/// and what the operator throws; the operator's data are then not to be used. Thread safety: one
/// caller.
template <class Op, class Work = std::vector<typename Op::Item>>
RoundsReport run_rounds_checked(const Executor& executor, Op& op, Work work,
                                const RoundsOptions& options = {}) {
  detail::expect_whole_operator<Op>();
  return detail::OperatorCheck<Op>(op, detail::strategy_of<Op>(executor, options))
      .run(detail::to_vector<typename Op::Item>(std::move(work)));
}

}  // namespace ductile::runtime
