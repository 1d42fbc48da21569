/// @file
/// run_rounds_checked: run_rounds for authors of operators. It is slow, runs on one thread, and
/// throws ContractBroken as soon as the operator does something that would be wrong, or would
/// depend on timing, on many threads. It detects items that change each other's plans although they
/// reached for nothing in common (in `tiles` and `colours`: have no conflict), and a plan() that
/// does not give up where it should, but not single reads and writes. It checks more if the
/// operator provides more:
///   Plan has ==            compares plans, not only whether there is one
///   to_string(Item)        messages name the item, not only its place (numbers name themselves)
/// An operator with a member `lowers_minima` lowers data that others have not reached for, as
/// LevelledOperator allows; then another item may lose its plan.
/// An operator with a member `forgoes_wakes` does not wake all items that could plan again.
#pragma once

#include <utility>
#include <vector>

#include "ductile/runtime/detail/contract.hpp"
#include "ductile/runtime/detail/operator_check.hpp"
#include "ductile/runtime/detail/strategies.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"

namespace ductile::runtime {

/// As run_rounds(), for copyable items; ignores most_rounds. Throws ContractBroken and whatever the
/// operator throws; do not use the operator's data then. Thread safety: one caller.
template <class Op, class Work = std::vector<typename Op::Item>>
RoundsReport run_rounds_checked(const Executor& /*one thread checks*/, Op& op, Work work,
                                const RoundsOptions& options = {}) {
  detail::expect_whole_operator<Op>();
  return detail::OperatorCheck<Op>(op, detail::strategy_of<Op>(options))
      .run(detail::to_vector<typename Op::Item>(std::move(work)));
}

}  // namespace ductile::runtime
