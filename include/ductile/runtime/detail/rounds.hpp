/// @file
/// Rounds: what run_rounds does, round after round, by the strategy that suits the operator.
#pragma once

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "ductile/runtime/detail/batches.hpp"
#include "ductile/runtime/detail/coloured_rounds.hpp"
#include "ductile/runtime/detail/reserving_rounds.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/recording.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime::detail {

/// Instead of OperatorCheck: nothing is checked.
struct NoCheck {
  static constexpr bool on = false;
};

template <class Op, class Check = NoCheck>
RoundsReport run_all_rounds(const Executor& executor, Op& op, std::vector<typename Op::Item> work,
                            const RoundsOptions& options) {
  using Strategy = std::conditional_t<ColouredOperator<Op>, ColouredRounds<Op, Check>,
                                      ReservingRounds<Op, Check>>;
  Batches<Op, Check> batches(executor, op, options);
  Strategy strategy(batches);
  Recording* const recording = executor.recording();
  for (std::uint32_t round = 1; !work.empty() && static_cast<int>(round) <= options.most_rounds;
       ++round) {
    ++batches.report.rounds;
    if (recording != nullptr) recording->begin_round();
    if constexpr (Check::on) batches.check.begin_round(op, round, work);
    work = strategy.run(std::move(work));
  }
  if (recording != nullptr) recording->end_rounds();
  batches.report.left = work.size();
  return batches.report;
}

}  // namespace ductile::runtime::detail
