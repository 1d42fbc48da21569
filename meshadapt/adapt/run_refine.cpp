#include <cmath>
#include <utility>

#include "adapt/workpiece.hpp"
#include "operators/edges.hpp"
#include "operators/refine.hpp"

namespace ductile::meshadapt {

namespace {

struct Splits {
  std::size_t count;
  bool left_lists_stale;
  VertexId first_vertex;  // of those it made
};

template <int Dim, int Space>
Splits split_edges_above(Workpiece<Dim, Space>& work, double limit) {
  const runtime::PhaseTimer timer(work.report_of(Kernel::refine).seconds);
  const std::uint32_t after = work.end_epoch(Kernel::refine);
  auto edges = long_edges(work.executor(), work.mesh(), work.survey_for(limit), limit, after);
  const bool shorter_are_for_later = limit > work.options().rules.long_edge;
  if (shorter_are_for_later) work.look_at_all(Kernel::refine);
  Refine<Dim, Space> refinement(work.executor(), work.mesh(), work.background(), work.rules());
  if (work.options().by_colours) refinement.defer_all_lists();
  const runtime::RoundsReport rounds = refinement.run(std::move(edges));
  work.add(Kernel::refine, rounds);
  return {rounds.applied, refinement.lists_are_stale(), refinement.first_vertex()};
}

}  // namespace

/// Renumbers the mesh if much is refined, which also makes the lists of elements anew.
/// New vertices of curved boundaries, which were made on chords, go to the model of the surface.
template <int Dim, int Space>
std::size_t run_refine(Workpiece<Dim, Space>& work, const Step& step) {
  const double limit = work.long_edge();
  if (std::isinf(limit)) return 0;
  const Splits splits = split_edges_above(work, limit);
  if (splits.left_lists_stale) work.renumber_mesh(splits.first_vertex);
  if (splits.count != 0 && work.options().move)
    run_smooth<Dim, Space>(work, {.kernel = Kernel::smooth, .move = Move::to_surface});
  work.tell(step.kernel, splits.count);
  return splits.count;
}

template std::size_t run_refine<2>(Workpiece<2>&, const Step&);
template std::size_t run_refine(Workpiece<2, 3>&, const Step&);
template std::size_t run_refine<3>(Workpiece<3>&, const Step&);

}  // namespace ductile::meshadapt
