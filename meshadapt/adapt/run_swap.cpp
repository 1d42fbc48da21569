#include <utility>

#include "adapt/run_by_conflicts.hpp"
#include "adapt/workpiece.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim, int Space>
runtime::RoundsReport run_swaps(Workpiece<Dim, Space>& work,
                                runtime::UnsetVector<Swappable> found) {
  if (work.options().by_colours) return swap_by_colours(work, std::move(found));
  Swap<Dim, Space> op(work.executor(), work.mesh(), work.range());
  return runtime::run_rounds_by<runtime::Strategy::reservations>(work.executor(), op,
                                                                 std::move(found));
}

}  // namespace

template <int Dim, int Space>
std::size_t run_swap(Workpiece<Dim, Space>& work, const Step& step) {
  const runtime::PhaseTimer timer(work.report_of(step.kernel).seconds);
  std::size_t changes = 0;
  for (int sweep = 0; sweep < step.sweeps; ++sweep) {
    const std::uint32_t after = work.end_epoch(step.kernel);
    auto found = Swap<Dim, Space>::improvements(work.executor(), work.mesh(), after, step.below,
                                                work.range());
    if (found.empty()) break;
    const runtime::RoundsReport rounds = run_swaps(work, std::move(found));
    work.add(step.kernel, rounds);
    changes += rounds.applied;
    if (work.share(rounds.applied) < step.enough) break;
  }
  work.tell(step.kernel, changes);
  return changes;
}

template std::size_t run_swap<2>(Workpiece<2>&, const Step&);
template std::size_t run_swap(Workpiece<2, 3>&, const Step&);
template std::size_t run_swap<3>(Workpiece<3>&, const Step&);

}  // namespace ductile::meshadapt
