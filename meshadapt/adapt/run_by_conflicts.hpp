/// @file
/// run_by_conflicts: how operators on vertices run that conflict with their neighbours.
#pragma once

#include "adapt/schedule.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <class Op>
runtime::RoundsReport run_by_conflicts(const runtime::Executor& executor, Op& op,
                                       const runtime::UnsetVector<VertexId>& work,
                                       bool by_colours) {
  using runtime::Strategy;
  constexpr runtime::RoundsOptions limits{.most_rounds = Thresholds::most_rounds};
  return by_colours ? runtime::run_rounds_by<Strategy::colours>(executor, op, work, limits)
                    : runtime::run_rounds_by<Strategy::tiles>(executor, op, work, limits);
}

}  // namespace ductile::meshadapt
