#include "adapt/run_by_conflicts.hpp"
#include "adapt/workpiece.hpp"
#include "operators/coarsen.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
std::size_t run_coarsen(Workpiece<Dim, Space>& work, const Step& step) {
  const runtime::PhaseTimer timer(work.report_of(step.kernel).seconds);
  const runtime::Executor& executor = work.executor();
  std::size_t changes = 0;
  for (int sweep = 0; sweep < step.sweeps; ++sweep) {
    const std::uint32_t after = work.end_epoch(step.kernel);
    const auto vertices = Coarsen<Dim, Space>::short_edge_vertices(
        executor, work.mesh(), work.survey_for(work.long_edge()), work.rules().short_edge, after);
    Coarsen<Dim, Space> op(work.mesh(), work.rules());
    const bool by_colours = work.options().by_colours;
    if (by_colours) op.defer_lists(executor);
    const runtime::RoundsReport rounds = run_by_conflicts(executor, op, vertices, by_colours);
    work.add(step.kernel, rounds);
    changes += rounds.applied;
    if (work.share(rounds.applied) < step.enough) break;
  }
  work.tell(step.kernel, changes);
  return changes;
}

template std::size_t run_coarsen<2>(Workpiece<2>&, const Step&);
template std::size_t run_coarsen(Workpiece<2, 3>&, const Step&);
template std::size_t run_coarsen<3>(Workpiece<3>&, const Step&);

}  // namespace ductile::meshadapt
