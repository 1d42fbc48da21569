#include <utility>

#include "adapt/run_by_conflicts.hpp"
#include "adapt/workpiece.hpp"
#include "operators/coarsen.hpp"
#include "operators/smooth.hpp"
#include "operators/swap_by_vertex.hpp"

namespace ductile::meshadapt {

using runtime::Strategy;

template <class Op>
runtime::RoundsReport run_by_colours(const runtime::Executor& executor, Op& op,
                                     const runtime::UnsetVector<VertexId>& work) {
  return runtime::run_rounds_by<Strategy::colours>(executor, op, work, conflict_limits);
}

template <int Dim, int Space>
runtime::RoundsReport swap_by_colours(Workpiece<Dim, Space>& work,
                                      runtime::UnsetVector<Swappable> found) {
  SwapByVertex<Dim, Space> op(work.executor(), work.mesh(), std::move(found), work.range());
  return runtime::run_rounds_by<Strategy::colours>(work.executor(), op, op.vertices());
}

template runtime::RoundsReport run_by_colours(const runtime::Executor&, Smooth<2>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport run_by_colours(const runtime::Executor&, Smooth<2, 3>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport run_by_colours(const runtime::Executor&, Smooth<3>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport run_by_colours(const runtime::Executor&, Coarsen<2>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport run_by_colours(const runtime::Executor&, Coarsen<2, 3>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport run_by_colours(const runtime::Executor&, Coarsen<3>&,
                                              const runtime::UnsetVector<VertexId>&);
template runtime::RoundsReport swap_by_colours(Workpiece<2>&, runtime::UnsetVector<Swappable>);
template runtime::RoundsReport swap_by_colours(Workpiece<2, 3>&, runtime::UnsetVector<Swappable>);
template runtime::RoundsReport swap_by_colours(Workpiece<3>&, runtime::UnsetVector<Swappable>);

}  // namespace ductile::meshadapt
