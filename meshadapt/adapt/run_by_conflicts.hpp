/// @file
/// run_by_conflicts: runs an operator on vertices that conflict with their neighbours, in tiles, or
/// by the published method. That is compiled in run_by_colours.cpp, apart from the default.
#pragma once

#include "adapt/schedule.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "mesh/mesh.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

/// Collapses wake each other many times, for little.
inline constexpr runtime::RoundsOptions conflict_limits{.most_rounds = Thresholds::most_rounds};

/// Smooth and Coarsen, class by class of a colouring.
template <class Op>
runtime::RoundsReport run_by_colours(const runtime::Executor& executor, Op& op,
                                     const runtime::UnsetVector<VertexId>& work);

/// Swaps, class by class; see swap_by_vertex.hpp.
template <int Dim, int Space>
runtime::RoundsReport swap_by_colours(Workpiece<Dim, Space>& work,
                                      runtime::UnsetVector<Swappable> found);

template <class Op>
runtime::RoundsReport run_by_conflicts(const runtime::Executor& executor, Op& op,
                                       const runtime::UnsetVector<VertexId>& work,
                                       bool by_colours) {
  if (by_colours) return run_by_colours(executor, op, work);
  return runtime::run_rounds_by<runtime::Strategy::tiles>(executor, op, work, conflict_limits);
}

}  // namespace ductile::meshadapt
