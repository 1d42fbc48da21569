#include "adapt/workpiece.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

using runtime::parallel_for;

namespace {

/// The mesh in an order in which neighbours in space are close in memory, every vertex with its
/// metric and with one of its elements as its host.
template <int Dim, int Space>
Mesh<Dim, Space> with_metrics(const runtime::Executor& executor, Start<Dim, Space>& start) {
  Mesh<Dim, Space> mesh = std::move(start.mesh);
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    mesh.site_of[v] = make_site(mesh.site_of[v].position, start.metric_of[v]);
  });
  renumber(executor, mesh, start.neighbours);
  parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    mesh.host_of[v] = mesh.elements_of.of(static_cast<VertexId>(v)).front();
  });
  return mesh;
}

}  // namespace

template <int Dim, int Space>
Workpiece<Dim, Space>::Workpiece(const runtime::Executor& executor, const AdaptOptions& options,
                                 Start<Dim, Space> start, AdaptReport& report)
    : executor_(executor),
      options_(options),
      mesh_(with_metrics(executor, start)),
      background_(executor, mesh_, std::move(start.neighbours)),
      report_(report) {
  update_qualities(executor_, mesh_);
}

template <int Dim, int Space>
Mesh<Dim, Space> Workpiece<Dim, Space>::take_mesh() {
  background_.release(executor_);
  survey_ = EdgeSurvey<Dim, Space>();
  return std::move(mesh_);
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::begin(const Phase& phase, bool came_adapted) {
  go_for(phase.aim, false);
  if (phase.aim != Aim::approach) go_to_last_stage();  // what is left is split at once
  const std::uint32_t now = mesh_.epoch - 1;
  everywhere_after_ = came_adapted ? now : 0;
  for (std::size_t k = 0; k < kernels.size(); ++k)
    if (phase.look[k] != Look::news) seen_by_[k] = phase.look[k] == Look::all ? 0 : now;
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::go_for(Aim aim, bool keeps_lengths) {
  aim_ = aim;
  keeps_lengths_ = keeps_lengths;
}

template <int Dim, int Space>
bool Workpiece<Dim, Space>::next_stage() {
  if (!options_.insert || stage_ == last_stage) return false;
  ++stage_;
  return true;
}

template <int Dim, int Space>
Rules Workpiece<Dim, Space>::rules() const {
  Rules rules = options_.rules;
  if (aim_ == Aim::approach) rules.kept_quality *= Tuning<Dim>::kept_quality;
  if (aim_ == Aim::rearrange) {
    rules.stretched_edge = Tuning<Dim>::stretched_edge;
    rules.short_edge *= Thresholds::eager;
  }
  if (aim_ == Aim::finish) {
    rules.extends_long_edges = false;
    rules.shortest_split = rules.short_edge;
  }
  return rules;
}

/// The range that moves and swaps leave edges in: at the end they may not undo what collapses and
/// splits have reached.
template <int Dim, int Space>
EdgeRange Workpiece<Dim, Space>::range() const {
  if (!keeps_lengths_) return {};
  return {options_.rules.short_edge, options_.rules.long_edge};
}

template <int Dim, int Space>
SmoothOptions Workpiece<Dim, Space>::smoothing(const Step& step) const {
  const bool to_surface = step.move == Move::to_surface;
  return {.laplacian = step.move == Move::laplacian,
          .optimise_below = to_surface ? 0 : step.below,
          .mean_below = aim_ == Aim::finish ? Tuning<Dim>::mean_below : 0,
          .far = care_of<Dim>(options_).far,
          // The next splits take edges that get a little too long on the way to the surface.
          .range = to_surface ? EdgeRange{} : range(),
          .to_surface = to_surface};
}

/// From which length on edges are split now.
template <int Dim, int Space>
double Workpiece<Dim, Space>::long_edge() const {
  return options_.rules.long_edge * Tuning<Dim>::stages[stage_];
}

/// The survey of edges, for those longer than this and all that any kernel takes for short.
template <int Dim, int Space>
EdgeSurvey<Dim, Space>& Workpiece<Dim, Space>::survey_for(double longer) {
  survey_.compare_with({.shorter = Thresholds::eager * options_.rules.short_edge,
                        .longer = std::isinf(longer) ? options_.rules.long_edge : longer});
  return survey_;
}

/// Ends the mesh's epoch for a scan that starts now; returns when the same kernel's last one ended.
template <int Dim, int Space>
std::uint32_t Workpiece<Dim, Space>::end_epoch(Kernel kernel) {
  return std::exchange(seen_by_[index_of(kernel)], mesh_.epoch++);
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::add(Kernel kernel, const runtime::RoundsReport& rounds) {
  if (rounds.applied != 0 && kernel_rows<Dim, Space>[index_of(kernel)].renews) {
    element_count_.reset();
    in_order_ = false;
  }
  KernelReport& sum = report_of(kernel);
  sum.considered += rounds.planned;
  sum.applied += rounds.applied;
  sum.rounds += rounds.rounds;
  sum.conflict_seconds += rounds.conflict_seconds;
  sum.plan_seconds += rounds.plan_seconds;
  sum.apply_seconds += rounds.apply_seconds;
  sum.commit_seconds += rounds.commit_seconds;
  sum.wake_seconds += rounds.wake_seconds;
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::tell(Kernel kernel, std::size_t changes) const {
  const AdaptProgress progress{kernels[index_of(kernel)].name, report_.iterations, changes};
  if (options_.progress && !options_.progress(progress)) throw Cancelled();
}

/// Counted only after a kernel has made or removed some.
template <int Dim, int Space>
std::size_t Workpiece<Dim, Space>::element_count() const {
  if (!element_count_)
    element_count_ = runtime::parallel_reduce(
        executor_, mesh_.element_slots(), std::size_t{0},
        [&](std::size_t e) { return std::size_t{mesh_.alive(static_cast<ElementId>(e))}; },
        std::plus<>());
  return *element_count_;
}

template <int Dim, int Space>
double Workpiece<Dim, Space>::share(std::size_t changes) const {
  return static_cast<double>(changes) /
         static_cast<double>(std::max<std::size_t>(1, element_count()));
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::renumber_mesh(VertexId unlisted) {
  const runtime::PhaseTimer timer(report_.renumber_seconds);
  renumber(executor_, mesh_, unlisted);
  in_order_ = true;
  survey_.forget();
}

template <int Dim, int Space>
void Workpiece<Dim, Space>::take_metrics() {
  parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    if (!mesh_.vertex_alive(v)) return;
    const auto [host, metric] = background_.sample(mesh_.site_of[v].position, mesh_.host_of[v]);
    mesh_.host_of[v] = host;
    mesh_.site_of[v] = make_site(mesh_.site_of[v].position, metric);
  });
  update_qualities(executor_, mesh_);
  survey_.forget();
  seen_by_ = {};
}

template class Workpiece<2>;
template class Workpiece<2, 3>;
template class Workpiece<3>;

}  // namespace ductile::meshadapt
