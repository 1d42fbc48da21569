/// @file
/// Rounds: what run_rounds does, round after round, by the strategy that suits the operator.
#pragma once

// How the headers in here hang together, from this one down:
//
//   rounds
//     coloured_rounds        operators with conflicts()
//       tiles                if they keep to their neighbours, conflicts stay, and the work is many
//       surveyed_tiles       if they keep to their neighbours, else, and for what tiles leave
//         ranked_blocks      of both: blocks that wait for each other, without barriers
//       batches              if not, or when rounds are checked: class by class of a colouring
//     reserving_rounds       operators with footprint()
//       batches              who holds all it has reserved: planned, applied and committed together
//   operator_check           what run_rounds_checked adds, with opposite_order
//
// Updates that are deferred lie in buckets and are put in order by source_order; items that are
// woken lie in a batch for each thread, then in segments.

#include <cstdint>
#include <type_traits>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/detail/batches.hpp"
#include "ductile/runtime/detail/coloured_rounds.hpp"
#include "ductile/runtime/detail/reserving_rounds.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/rounds_report.hpp"

namespace ductile::runtime::detail {

/// Instead of OperatorCheck: nothing is checked.
struct NoCheck {
  static constexpr bool on = false;
};

/// The work is a vector of items.
template <class Op, class Check = NoCheck>
RoundsReport run_all_rounds(const Executor& executor, Op& op, auto first_work,
                            const RoundsOptions& options) {
  using Item = typename Op::Item;
  using Strategy = std::conditional_t<ColouredOperator<Op>, ColouredRounds<Op, Check>,
                                      ReservingRounds<Op, Check>>;
  Batches<Op, Check> batches(executor, op, options);
  Strategy strategy(batches);
  RoundsReport& report = batches.report;
  report.left = first_work.size();
  const auto goes_on = [&] {
    return report.left > 0 && static_cast<int>(report.rounds) < options.most_rounds;
  };
  const auto run_round = [&](auto work) {
    ++report.rounds;
    if constexpr (Check::on)
      batches.check.begin_round(op, static_cast<std::uint32_t>(report.rounds), work);
    UnsetVector<Item> next = strategy.run(std::move(work));
    report.left = next.size();
    return next;
  };
  const auto run_while_it_goes_on = [&] {
    UnsetVector<Item> work = run_round(std::move(first_work));
    while (goes_on()) work = run_round(std::move(work));
  };
  if (goes_on()) with_team(executor, run_while_it_goes_on);
  return report;
}

}  // namespace ductile::runtime::detail
