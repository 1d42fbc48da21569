#include "adapt/adapter.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "adapt/metric_path.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "metric/demand.hpp"
#include "operators/edges.hpp"
#include "operators/remaining_work.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
Adapter<Dim, Space>::Adapter(const runtime::Executor& executor, const AdaptOptions& options,
                             Start<Dim, Space> start, AdaptReport& report)
    : executor_(executor), options_(options), work_(executor, options, std::move(start), report) {}

template <int Dim, int Space>
std::optional<Effort> Adapter<Dim, Space>::run(Effort effort) {
  if (effort == Effort::nothing) report().converged = true;
  if (effort == Effort::mending && options_.insert && !mend(share_to_change()))
    return Effort::nothing;
  if (effort == Effort::as_needed && !options_.approach_only) return adapt_as_needed();
  if (effort <= Effort::as_needed) adapt_anew();
  return std::nullopt;
}

template <int Dim, int Space>
std::optional<Effort> Adapter<Dim, Space>::adapt_as_needed() {
  const double wanted = share_to_change();
  // Rules that refuse changes next to poor elements may hide what there is to do.
  const bool many_are_poor =
      work_.share(elements_below(RemainingWork<Dim, Space>::poor)) >= Thresholds::many_poor;
  if (options_.insert && wanted < Thresholds::little && !many_are_poor)
    return mend(wanted) ? std::nullopt : std::optional(Effort::nothing);
  const bool doubtful = !options_.insert || wanted < Thresholds::not_much;
  const Standing before = doubtful ? standing() : Standing{};
  adapt_anew();
  if (doubtful && !is_better(standing(), before, after_a_run)) return Effort::mending;
  return std::nullopt;
}

/// Finishes the mesh where there is something to do. Returns false if it should be left as it came:
/// much has changed without making it clearly better, or much is still to be done, because splits
/// next to thin elements that cannot go may make others like them without end.
template <int Dim, int Space>
bool Adapter<Dim, Space>::mend(double wanted) {
  report().converged = true;
  came_adapted_ = true;
  if (wanted < Thresholds::nothing) return true;
  const std::uint32_t epoch = mesh().epoch;
  const Standing before = standing();
  follow(schedule_for<Dim>(options_).finish);
  const bool in_vain = work_.share(elements_changed_after(epoch)) >= Thresholds::little &&
                       !is_better(standing(), before, after_mending);
  return !in_vain && share_to_change() < Thresholds::little;
}

template <int Dim, int Space>
void Adapter<Dim, Space>::adapt_anew() {
  const Schedule<Dim> schedule = schedule_for<Dim>(options_);
  approach(schedule.approach);
  if (options_.approach_only) return;
  if (options_.insert) follow(schedule.rearrange);
  follow(schedule.settle);
  follow(schedule.polish);
  follow(schedule.raise);
  if (options_.insert) follow(schedule.finish);
}

/// One round of the kernels of a phase that are allowed; returns how many of their changes count.
template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::pass(const Phase& phase) {
  std::size_t changes = 0;
  for (const Step& step : phase.steps) {
    const bool may_renumber = step.renumber_above < never && !work_.is_in_order();
    if (may_renumber && work_.share(changes) > step.renumber_above) work_.renumber_mesh();
    const KernelRow<Dim, Space>& kernel = kernel_rows<Dim, Space>[index_of(step.kernel)];
    if (!(options_.*kernel.allowed)) continue;
    do {
      const std::size_t made = kernel.run(work_, step);
      if (kernel.counts) changes += made;
    } while (step.next_stage_below > 0 && work_.share(changes) < step.next_stage_below &&
             work_.next_stage());
  }
  return changes;
}

/// Moves and swaps keep lengths at the end; in a mesh that did not come adapted, not yet the first
/// time, so there is a second time.
template <int Dim, int Space>
void Adapter<Dim, Space>::follow(const Phase& phase) {
  work_.begin(phase, came_adapted_);
  for (int times = 0; times < phase.passes; ++times) {
    const bool keeps_lengths = phase.aim == Aim::finish && (came_adapted_ || times > 0);
    work_.go_for(phase.aim, keeps_lengths);
    const bool is_calm = work_.share(pass(phase)) < phase.calm;
    if (is_calm && (keeps_lengths || phase.aim != Aim::finish)) break;
  }
}

/// Few changes may be the beginning of many, where a thin layer is split in halves.
template <int Dim, int Space>
void Adapter<Dim, Space>::approach(const Phase& phase) {
  int& rounds = report().iterations = 0;
  bool& converged = report().converged = false;
  work_.begin(phase, false);
  if (options_.insert && is_far()) come_near(phase);
  while (!converged && rounds < phase.passes) {
    ++rounds;
    const double changed = work_.share(pass(phase));
    const bool calm =
        changed < phase.calm && (changed < Thresholds::hardly_any ||
                                 work_.share(splits_to_come()) < Thresholds::many_splits_left);
    converged = calm && !work_.next_stage();
  }
}

template <int Dim, int Space>
Standing Adapter<Dim, Space>::standing() const {
  const EdgeRange wanted{options_.rules.short_edge, options_.rules.long_edge};
  return standing_of(executor_, mesh(), wanted, RemainingWork<Dim, Space>::poor);
}

template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::count_elements(auto&& counts) const {
  return runtime::parallel_reduce(
      executor_, mesh().element_slots(), std::size_t{0},
      [&](std::size_t e) {
        return std::size_t{mesh().alive(static_cast<ElementId>(e)) && counts(e)};
      },
      std::plus<>());
}

template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::elements_below(double mean_ratio) const {
  const double quality = quality_of_mean_ratio<Dim>(mean_ratio);
  return count_elements([&](std::size_t e) { return mesh().quality_of[e] < quality; });
}

/// Existing elements that were made, moved or swapped since that epoch.
template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::elements_changed_after(std::uint32_t epoch) const {
  return count_elements([&](std::size_t e) { return mesh().changed_at[e] > epoch; });
}

/// Are most elements slivers in the metric, or some, and many to be made where sizes jump, or where
/// facets of curved boundaries, slivers too, can hardly change?
template <int Dim, int Space>
bool Adapter<Dim, Space>::is_far() const {
  const double slivers = work_.share(elements_below(Tuning<Dim>::far));
  if (slivers > Thresholds::most_slivers) return true;
  return slivers > Thresholds::some_slivers &&
         (mesh().surface || share_of_steep(executor_, mesh()) > Thresholds::much_of_demand);
}

/// Adapts to metrics on the way to one that is far, roughly, before what is done for any.
template <int Dim, int Space>
void Adapter<Dim, Space>::come_near(const Phase& phase) {
  MetricPath<Dim, Space> path(executor_, mesh(), work_.background(),
                              share_of_steep(executor_, mesh()) > Thresholds::much_of_demand);
  work_.go_to_last_stage();  // none is far from the one before
  for (int step = 1; step <= path.steps(); ++step) {
    if (step > 1 && has_too_many()) step = path.steps();
    path.go_to(step);
    work_.take_metrics();
    bool is_near = step == path.steps();
    for (int round = 0; round < Thresholds::rounds_on_the_way && !is_near; ++round)
      is_near = work_.share(pass(phase)) < Thresholds::near;
  }
}

/// Are there many more elements than the metric of the background asks for? Where directions turn
/// within elements they grow on the way, from step to step.
template <int Dim, int Space>
bool Adapter<Dim, Space>::has_too_many() const {
  const double wanted = work_.background().complexity(executor_);
  const auto elements = static_cast<double>(work_.element_count());
  return complexity_of_elements(Dim, elements) > Thresholds::too_many * wanted;
}

/// Share of the elements next to which something would be done, or what it is at least where that
/// is not little. A mesh that comes adapted shall stay as it is.
template <int Dim, int Space>
double Adapter<Dim, Space>::share_to_change() {
  if (!options_.insert) return 1;
  work_.go_for(Aim::finish, true);
  const auto count = static_cast<double>(least_count());
  const Rules rules = work_.rules();
  const Step& last_move = Steps<Dim>::raise[0];
  RemainingWork<Dim, Space> remaining(
      executor_, work_.mesh(), work_.background(),
      {.rules = rules,
       .smooth = work_.smoothing(last_move),
       .swap_below = Tuning<Dim>::swap_below,
       .swaps = options_.swap,
       .moves = options_.move,
       .few = static_cast<std::size_t>(Thresholds::little * count)});
  const double share =
      static_cast<double>(remaining.count(work_.survey_for(rules.long_edge))) / count;
  if (share < Thresholds::little) remaining.touch_poor();
  work_.go_for(Aim::approach, false);
  return share;
}

template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::least_count() const {
  return std::max(Thresholds::least_count, work_.element_count());
}

template <int Dim, int Space>
std::size_t Adapter<Dim, Space>::splits_to_come() {
  const double limit = options_.rules.long_edge;
  const auto edges = long_edges(executor_, mesh(), work_.survey_for(limit), limit, 0);
  return runtime::parallel_reduce(
      executor_, edges.size(), std::size_t{0},
      [&](std::size_t i) { return splits_of(edges[i], limit); }, std::plus<>());
}

template class Adapter<2>;
template class Adapter<2, 3>;
template class Adapter<3>;

}  // namespace ductile::meshadapt
