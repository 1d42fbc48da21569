#include "adapt/run_by_conflicts.hpp"
#include "adapt/workpiece.hpp"
#include "operators/smooth.hpp"

namespace ductile::meshadapt {

namespace {

/// The vertices that one sweep looks at; to the model of the surface those come that were made on
/// chords.
template <int Dim, int Space>
runtime::UnsetVector<VertexId> work_for(Workpiece<Dim, Space>& work, const Step& step) {
  const runtime::Executor& executor = work.executor();
  if (step.move == Move::to_surface)
    return Smooth<Dim, Space>::vertices_on_surface(executor, work.mesh(),
                                                   step.everywhere ? 0 : work.mesh().epoch - 1);
  const std::uint32_t after = work.end_epoch(step.kernel);
  return step.move == Move::laplacian
             ? Smooth<Dim, Space>::movable_vertices(executor, work.mesh(), after)
             : Smooth<Dim, Space>::movable_vertices_of_poor(executor, work.mesh(), step.below,
                                                            after);
}

}  // namespace

template <int Dim, int Space>
std::size_t run_smooth(Workpiece<Dim, Space>& work, const Step& step) {
  const bool to_surface = step.move == Move::to_surface;
  if (to_surface && !work.mesh().surface) return 0;
  const runtime::PhaseTimer timer(work.report_of(step.kernel).seconds);
  if (step.everywhere && !to_surface) work.look_everywhere(step.kernel);
  Smooth<Dim, Space> op(work.mesh(), work.background(), work.smoothing(step));
  std::size_t changes = 0;
  for (int sweep = 0; sweep < step.sweeps; ++sweep) {
    const runtime::RoundsReport rounds =
        run_by_conflicts(work.executor(), op, work_for(work, step), work.options().by_colours);
    work.add(step.kernel, rounds);
    changes += rounds.applied;
  }
  if (changes != 0) work.forget_survey();
  if (!to_surface) work.tell(step.kernel, changes);
  return changes;
}

template std::size_t run_smooth<2>(Workpiece<2>&, const Step&);
template std::size_t run_smooth(Workpiece<2, 3>&, const Step&);
template std::size_t run_smooth<3>(Workpiece<3>&, const Step&);

}  // namespace ductile::meshadapt
