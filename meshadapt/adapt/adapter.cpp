#include "adapt/adapter.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "adapt/metric_path.hpp"
#include "adapt/tuning.hpp"
#include "ductile/meshadapt/complexity.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/operator.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "metric/demand.hpp"
#include "operators/coarsen.hpp"
#include "operators/refine.hpp"
#include "operators/remaining_work.hpp"
#include "operators/smooth.hpp"
#include "operators/swap.hpp"
#include "operators/swap_by_vertex.hpp"

namespace ductile::meshadapt {

using runtime::parallel_for;
using runtime::RoundsReport;
using runtime::run_rounds_by;
using runtime::Strategy;

namespace {

/// A mesh of which a smaller share would change is left alone, or only mended, or only mended
/// unless it gets clearly better by more.
constexpr double nothing = 2e-4, little = 0.02, not_much = 0.06;

/// Of elements, whatever could be done about them.
constexpr double many_poor = 5e-3;

/// Of what the metric asks for, in elements that are much too coarse for how sizes change.
constexpr double much_of_demand = 0.2;

/// Of elements: where a sweep of collapses makes fewer, what it leaves waits for the next round of
/// all kernels. Most of that is refused again as long as nothing else has changed.
constexpr double many_collapses = 0.1;

/// Rearranging also collapses edges that are hardly long enough: some would end up too short.
constexpr double eager = 1.03;

/// The mesh in an order in which what is near in space is near in memory, every vertex with its
/// metric and with one of its elements as its host.
template <int Dim>
Mesh<Dim> with_metrics(const runtime::Executor& executor, Mesh<Dim> mesh,
                       const std::vector<Metric<Dim>>& metric_of, Neighbours<Dim>& neighbours) {
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    mesh.site_of[v] = make_site(mesh.site_of[v].position, metric_of[v]);
  });
  renumber(executor, mesh, neighbours);
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    mesh.host_of[v] = mesh.elements_of.of(static_cast<VertexId>(v)).front();
  });
  return mesh;
}

}  // namespace

template <int Dim>
Adapter<Dim>::Adapter(const runtime::Executor& executor, const AdaptOptions& options,
                      Mesh<Dim> mesh, Neighbours<Dim> neighbours,
                      const std::vector<Metric<Dim>>& metric_of)
    : executor_(executor),
      options_(options),
      mesh_(with_metrics(executor, std::move(mesh), metric_of, neighbours)),
      background_(executor, mesh_, std::move(neighbours)) {
  update_qualities(executor_, mesh_);
}

template <int Dim>
void Adapter<Dim>::run() {
  const double wanted = share_to_change();
  // Rules that refuse what is next to poor elements may hide what there is to do.
  const bool many_are_poor = share(elements_below(RemainingWork<Dim>::poor)) >= many_poor;
  if (options_.insert && wanted < little && !many_are_poor) return mend(wanted);
  const bool doubtful = !options_.insert || wanted < not_much;
  const Standing before = doubtful ? standing() : Standing{};
  adapt_anew();
  if (doubtful && !is_better(standing(), before, after_a_run)) outcome_ = Outcome::better_mended;
}

template <int Dim>
void Adapter<Dim>::mend() {
  if (options_.insert) mend(share_to_change());
}

/// Does what is to be done next to where it is to be done, if anything is. Where that changes more
/// than little, the mesh must be clearly better for it; and next to elements that are thin and
/// cannot go, splits may make others like them, without an end.
template <int Dim>
void Adapter<Dim>::mend(double wanted) {
  report_.converged = true;
  came_adapted_ = true;
  stage_ = std::size(Tuning<Dim>::stages) - 1;  // what is long is split at once
  if (wanted < nothing) return;
  const std::uint32_t epoch = mesh_.epoch;
  const Standing before = standing();
  finish();
  const bool in_vain = share(elements_changed_after(epoch)) >= little &&
                       !is_better(standing(), before, after_mending);
  if (in_vain || share_to_change() >= little) outcome_ = Outcome::better_left;
}

template <int Dim>
void Adapter<Dim>::adapt_anew() {
  report_.iterations = 0;
  report_.converged = false;
  if (options_.insert && is_far()) come_near();
  while (!report_.converged && report_.iterations < options_.iterations) {
    ++report_.iterations;
    const double changed = share(iterate());
    // Few changes may be the beginning of many, where a thin layer is split in halves.
    const bool calm =
        changed < care_of<Dim>(options_).calm && (changed < 5e-3 || share(splits_to_come()) < 0.1);
    report_.converged = calm && !next_stage();
  }
  stage_ = std::size(Tuning<Dim>::stages) - 1;  // what is left is split at once
  rearrange();
  polish();
  finish();
}

template <int Dim>
Standing Adapter<Dim>::standing() const {
  const EdgeRange wanted{options_.rules.short_edge, options_.rules.long_edge};
  return standing_of(executor_, mesh_, wanted, RemainingWork<Dim>::poor);
}

template <int Dim>
std::size_t Adapter<Dim>::elements_below(double mean_ratio) const {
  const double quality = quality_of_mean_ratio<Dim>(mean_ratio);
  const auto is_below = [&](std::size_t e) -> std::size_t {
    return mesh_.alive(static_cast<ElementId>(e)) && mesh_.quality_of[e] < quality;
  };
  return runtime::parallel_reduce(executor_, mesh_.element_slots(), std::size_t{0}, is_below,
                                  std::plus<>());
}

/// Those that are there now: made, moved or swapped since that epoch.
template <int Dim>
std::size_t Adapter<Dim>::elements_changed_after(std::uint32_t epoch) const {
  const auto is_changed = [&](std::size_t e) -> std::size_t {
    return mesh_.alive(static_cast<ElementId>(e)) && mesh_.changed_at[e] > epoch;
  };
  return runtime::parallel_reduce(executor_, mesh_.element_slots(), std::size_t{0}, is_changed,
                                  std::plus<>());
}

/// Are most elements slivers in the metric, or some, and many to be made where sizes jump?
template <int Dim>
bool Adapter<Dim>::is_far() const {
  const double slivers = share(elements_below(Tuning<Dim>::far));
  return slivers > 0.5 || (slivers > 0.02 && share_of_steep(executor_, mesh_) > much_of_demand);
}

/// Adapts to metrics on the way to one that is far, roughly, before what is done for any.
template <int Dim>
void Adapter<Dim>::come_near() {
  constexpr int most_rounds = 6;  // to each
  MetricPath<Dim> path(executor_, mesh_, background_,
                       share_of_steep(executor_, mesh_) > much_of_demand);
  stage_ = std::size(Tuning<Dim>::stages) - 1;  // none is far from the one before
  for (int step = 1; step <= path.steps(); ++step) {
    if (step > 1 && has_too_many()) step = path.steps();
    path.go_to(step);
    take_metrics();
    bool is_near = step == path.steps();
    for (int round = 0; round < most_rounds && !is_near; ++round) is_near = share(iterate()) < 0.1;
  }
}

/// Are there many more elements than the metric of the background asks for? Where directions turn
/// within elements they grow on the way, from step to step.
template <int Dim>
bool Adapter<Dim>::has_too_many() const {
  const double wanted = background_.complexity(executor_);
  return complexity_of_elements(Dim, static_cast<double>(element_count())) > 1.5 * wanted;
}

/// Those that the background has now.
template <int Dim>
void Adapter<Dim>::take_metrics() {
  parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    if (!mesh_.vertex_alive(v)) return;
    const auto [host, metric] = background_.sample(mesh_.site_of[v].position, mesh_.host_of[v]);
    mesh_.host_of[v] = host;
    mesh_.site_of[v] = make_site(mesh_.site_of[v].position, metric);
  });
  update_qualities(executor_, mesh_);
  survey_.forget();
  seen_by_coarsen_ = seen_by_refine_ = seen_by_swap_ = seen_by_smooth_ = 0;
}

/// Share of the elements next to which something would be done, or what it is at least where that
/// is not little. A mesh that comes adapted shall stay as it is.
template <int Dim>
double Adapter<Dim>::share_to_change() {
  if (!options_.insert) return 1;
  aim_ = Aim::finish;
  keeps_lengths_ = true;
  const auto few = static_cast<std::size_t>(little * static_cast<double>(least_count()));
  RemainingWork<Dim> work(executor_, mesh_, background_,
                          {.rules = rules(),
                           .smooth = smoothing(Tuning<Dim>::optimise_below, false),
                           .swap_below = Tuning<Dim>::swap_below,
                           .swaps = options_.swap,
                           .moves = options_.move,
                           .few = few});
  const double share = static_cast<double>(work.count(survey_for(rules().long_edge))) /
                       static_cast<double>(least_count());
  if (share < little) work.touch_poor();
  aim_ = Aim::approach;
  keeps_lengths_ = false;
  return share;
}

/// One change is no small share of a small mesh, but it is little work.
template <int Dim>
std::size_t Adapter<Dim>::least_count() const {
  return std::max<std::size_t>(100, element_count());
}

template <int Dim>
std::size_t Adapter<Dim>::splits_to_come() {
  const double limit = options_.rules.long_edge;
  const auto edges = long_edges(executor_, mesh_, survey_for(limit), limit, 0);
  return runtime::parallel_reduce(
      executor_, edges.size(), std::size_t{0},
      [&](std::size_t i) { return splits_of(edges[i], limit); }, std::plus<>());
}

template <int Dim>
double Adapter<Dim>::share(std::size_t changes) const {
  return static_cast<double>(changes) /
         static_cast<double>(std::max<std::size_t>(1, element_count()));
}

template <int Dim>
Rules Adapter<Dim>::rules() const {
  Rules rules = options_.rules;
  if (aim_ == Aim::approach) rules.kept_quality *= Tuning<Dim>::kept_quality;
  if (aim_ == Aim::rearrange) {
    rules.stretched_edge = Tuning<Dim>::stretched_edge;
    rules.short_edge *= eager;
  }
  if (aim_ == Aim::finish) {
    rules.extends_long_edges = false;
    rules.shortest_split = rules.short_edge;
  }
  return rules;
}

/// What moves and swaps leave edges in: in the end they may undo nothing of what collapses and
/// splits have reached.
template <int Dim>
EdgeRange Adapter<Dim>::range() const {
  if (!keeps_lengths_) return {};
  return {options_.rules.short_edge, options_.rules.long_edge};
}

template <int Dim>
bool Adapter<Dim>::next_stage() {
  if (!options_.insert || stage_ + 1 == std::size(Tuning<Dim>::stages)) return false;
  ++stage_;
  return true;
}

/// One round of all kernels. Refinement is one stage further in each, or more if there is little
/// else to do.
template <int Dim>
std::size_t Adapter<Dim>::iterate() {
  std::size_t changes = 0;
  if (options_.insert) {
    changes += coarsen();
    changes += refine();
  }
  while (share(changes) < 0.02 && next_stage()) changes += refine();
  // In 2D order matters less than the time to restore it, unless much has changed.
  if (!in_order_ && (Dim == 3 || share(changes) > 0.05)) renumber_mesh();
  changes += swap(8, Tuning<Dim>::swap_below);
  smooth(1, 0.3, true);
  return changes;
}

/// Collapses what is left of short edges, swaps and smooths, and only then splits what has become
/// too long. Smooths next to changes alone.
template <int Dim>
void Adapter<Dim>::rearrange() {
  if (!options_.insert) return;
  aim_ = Aim::rearrange;
  seen_by_coarsen_ = 0;
  seen_by_smooth_ = mesh_.epoch - 1;
  for (int pass = 0; pass < Tuning<Dim>::rearrangements; ++pass) {
    coarsen();
    swap(4, Tuning<Dim>::swap_below);
    smooth(1, Tuning<Dim>::optimise_below, true);
    refine();
    swap(4, Tuning<Dim>::swap_below);
    if (Dim == 2) smooth(1, Tuning<Dim>::optimise_below, true);  // else what comes next does
  }
}

/// Raises quality without aiming at lengths.
template <int Dim>
void Adapter<Dim>::polish() {
  settle(0);
  for (int pass = 0; pass < care_of<Dim>(options_).polishes; ++pass) {
    smooth(3, 0.5, true);
    swap(4, Tuning<Dim>::swap_below);
  }
  seen_by_smooth_ = 0;
  smooth(2, Tuning<Dim>::optimise_below, false);
}

/// Until there is nothing to do: adapting the result again shall change nothing. In a mesh that
/// came adapted vertices move only next to changes.
template <int Dim>
void Adapter<Dim>::finish() {
  if (!options_.insert) return;
  aim_ = Aim::finish;
  seen_by_coarsen_ = seen_by_refine_ = seen_by_swap_ = 0;
  const std::uint32_t before = came_adapted_ ? mesh_.epoch - 1 : 0;
  keeps_lengths_ = came_adapted_;
  for (int pass = 0; pass < 10; ++pass) {
    std::size_t changes = coarsen();
    changes += swap(4, Tuning<Dim>::swap_below);
    changes += refine();
    changes += swap(4, Tuning<Dim>::swap_below);
    seen_by_smooth_ = before;
    smooth(1, Tuning<Dim>::optimise_below, false);
    keeps_lengths_ = true;
    if (share(changes) < 1e-4) break;
  }
}

/// Ends the mesh's epoch for a scan that starts now; returns when the same kernel's last one ended.
template <int Dim>
std::uint32_t Adapter<Dim>::end_epoch(std::uint32_t& seen) {
  return std::exchange(seen, mesh_.epoch++);
}

/// From which length on edges are split now.
template <int Dim>
double Adapter<Dim>::long_edge() const {
  return options_.rules.long_edge * Tuning<Dim>::stages[stage_];
}

/// The survey of edges, for those longer than this and all that any kernel takes for short.
template <int Dim>
EdgeSurvey<Dim>& Adapter<Dim>::survey_for(double longer) {
  survey_.compare_with({.shorter = eager * options_.rules.short_edge,
                        .longer = std::isinf(longer) ? options_.rules.long_edge : longer});
  return survey_;
}

/// Collapses may wake each other many times, for little; moves wake nobody.
template <int Dim>
template <class Op>
RoundsReport Adapter<Dim>::run_by_conflicts(Op& op,
                                            const runtime::UnsetVector<VertexId>& work) const {
  constexpr runtime::RoundsOptions limits{.most_rounds = 30};
  return options_.by_colours ? run_rounds_by<Strategy::colours>(executor_, op, work, limits)
                             : run_rounds_by<Strategy::tiles>(executor_, op, work, limits);
}

template <int Dim>
std::size_t Adapter<Dim>::coarsen() {
  const runtime::PhaseTimer timer(report_.coarsen.seconds);
  std::size_t changes = 0;
  for (int sweep = 0; sweep < 8; ++sweep) {
    const std::uint32_t after = end_epoch(seen_by_coarsen_);
    const auto work = Coarsen<Dim>::short_edge_vertices(executor_, mesh_, survey_for(long_edge()),
                                                        rules().short_edge, after);
    Coarsen<Dim> op(mesh_, rules());
    if (options_.by_colours) op.defer_lists(executor_);
    const RoundsReport rounds = run_by_conflicts(op, work);
    add(report_.coarsen, rounds);
    changes += rounds.applied;
    if (share(rounds.applied) < many_collapses) break;
  }
  tell("coarsen", changes);
  return changes;
}

/// Renumbers where much is refined, which makes lists of elements anew, as they are then to be.
template <int Dim>
std::size_t Adapter<Dim>::refine() {
  const double limit = long_edge();
  if (std::isinf(limit)) return 0;
  const Splits splits = split_edges_above(limit);
  if (splits.left_lists_stale) renumber_mesh(splits.first_vertex);
  if (splits.count != 0) settle(mesh_.epoch - 1);
  tell("refine", splits.count);
  return splits.count;
}

template <int Dim>
auto Adapter<Dim>::split_edges_above(double limit) -> Splits {
  const runtime::PhaseTimer timer(report_.refine.seconds);
  const std::uint32_t after = end_epoch(seen_by_refine_);
  auto work = long_edges(executor_, mesh_, survey_for(limit), limit, after);
  if (limit > options_.rules.long_edge) seen_by_refine_ = 0;  // shorter ones are for later
  Refine<Dim> refinement(executor_, mesh_, background_, rules());
  if (options_.by_colours) refinement.defer_all_lists();
  const RoundsReport rounds = refinement.run(std::move(work));
  add(report_.refine, rounds);
  return {rounds.applied, refinement.lists_are_stale(), refinement.first_vertex()};
}

template <int Dim>
std::size_t Adapter<Dim>::swap(int sweeps, double below) {
  if (!options_.swap) return 0;
  const runtime::PhaseTimer timer(report_.swap.seconds);
  std::size_t changes = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    auto work = Swap<Dim>::improvements(executor_, mesh_, end_epoch(seen_by_swap_), below, range());
    if (work.empty()) break;
    const RoundsReport rounds = run_swaps(std::move(work));
    add(report_.swap, rounds);
    changes += rounds.applied;
    if (share(rounds.applied) < (aim_ == Aim::finish ? 5e-5 : 0.015)) break;
  }
  tell("swap", changes);
  return changes;
}

template <int Dim>
RoundsReport Adapter<Dim>::run_swaps(runtime::UnsetVector<Swappable> work) {
  if (options_.by_colours) {
    SwapByVertex<Dim> op(executor_, mesh_, std::move(work), range());
    return run_rounds_by<Strategy::colours>(executor_, op, op.vertices());
  }
  Swap<Dim> op(executor_, mesh_, range());
  return run_rounds_by<Strategy::reservations>(executor_, op, std::move(work));
}

template <int Dim>
SmoothOptions Adapter<Dim>::smoothing(double optimise_below, bool laplacian) const {
  return {.laplacian = laplacian,
          .optimise_below = optimise_below,
          .mean_below = aim_ == Aim::finish ? Tuning<Dim>::mean_below : 0,
          .far = care_of<Dim>(options_).far,
          .range = range()};
}

template <int Dim>
std::size_t Adapter<Dim>::smooth(int sweeps, double optimise_below, bool laplacian) {
  if (!options_.move) return 0;
  const runtime::PhaseTimer timer(report_.smooth.seconds);
  Smooth<Dim> op(mesh_, background_, smoothing(optimise_below, laplacian));
  std::size_t changes = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::uint32_t after = end_epoch(seen_by_smooth_);
    auto work =
        laplacian ? Smooth<Dim>::movable_vertices(executor_, mesh_, after)
                  : Smooth<Dim>::movable_vertices_of_poor(executor_, mesh_, optimise_below, after);
    const RoundsReport rounds = run_by_conflicts(op, work);
    add(report_.smooth, rounds);
    changes += rounds.applied;
  }
  if (changes != 0) survey_.forget();
  tell("smooth", changes);
  return changes;
}

/// Brings vertices of curved boundaries that were made on chords, next to what has changed after an
/// epoch, to the model of the surface.
template <int Dim>
void Adapter<Dim>::settle(std::uint32_t after) {
  if (!options_.move || !mesh_.surface) return;
  const runtime::PhaseTimer timer(report_.smooth.seconds);
  SmoothOptions options = smoothing(0, false);
  options.to_surface = true;
  options.range = {};  // what gets a little too long by that is for the next splits
  Smooth<Dim> op(mesh_, background_, options);
  const RoundsReport rounds =
      run_by_conflicts(op, Smooth<Dim>::vertices_on_surface(executor_, mesh_, after));
  add(report_.smooth, rounds);
  if (rounds.applied != 0) survey_.forget();
}

template <int Dim>
void Adapter<Dim>::renumber_mesh(VertexId unlisted) {
  const runtime::PhaseTimer timer(report_.renumber_seconds);
  renumber(executor_, mesh_, unlisted);
  in_order_ = true;
  survey_.forget();
}

/// Counted only after a kernel has made or removed some.
template <int Dim>
std::size_t Adapter<Dim>::element_count() const {
  if (!element_count_)
    element_count_ = runtime::parallel_reduce(
        executor_, mesh_.element_slots(), std::size_t{0},
        [&](std::size_t e) { return std::size_t{mesh_.alive(static_cast<ElementId>(e))}; },
        std::plus<>());
  return *element_count_;
}

template <int Dim>
void Adapter<Dim>::tell(const char* step, std::size_t changes) const {
  if (options_.progress && !options_.progress({step, report_.iterations, changes}))
    throw Cancelled();
}

template <int Dim>
void Adapter<Dim>::add(KernelReport& kernel, const RoundsReport& rounds) {
  const bool flips = Dim == 2 && &kernel == &report_.swap;
  if (rounds.applied != 0 && !flips && &kernel != &report_.smooth) {
    element_count_.reset();
    in_order_ = false;
  }
  kernel.considered += rounds.planned;
  kernel.applied += rounds.applied;
  kernel.rounds += rounds.rounds;
  kernel.conflict_seconds += rounds.conflict_seconds;
  kernel.plan_seconds += rounds.plan_seconds;
  kernel.apply_seconds += rounds.apply_seconds;
  kernel.commit_seconds += rounds.commit_seconds;
  kernel.wake_seconds += rounds.wake_seconds;
}

template class Adapter<2>;
template class Adapter<3>;

}  // namespace ductile::meshadapt
