#include "operators/adapter.hpp"

#include <chrono>
#include <limits>
#include <span>
#include <utility>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/recording.hpp"
#include "operators/coarsen.hpp"
#include "operators/refine.hpp"
#include "operators/smooth.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

using runtime::parallel_for;
using runtime::RoundsReport;

namespace {

/// How much longer than the rules want edges must be to be split, by stage. In 3D, coarsening and
/// swapping shorten many long edges, so the first stage splits none, and each after it what is left
/// of the longest.
constexpr double stages_2d[] = {1.4, 1.13, 1};
constexpr double stages_3d[] = {std::numeric_limits<double>::infinity(), 2.5, 1.7, 1.25, 1};

template <int Dim>
constexpr std::span<const double> refinement_stages() {
  if constexpr (Dim == 2)
    return stages_2d;
  else
    return stages_3d;
}

/// When few changes are left to make, this many iterations also collapse edges that are too short
/// if that makes some too long: splits and swaps then find a better way to fill the same place.
/// Doing so from the start costs more than it gains.
/// In 2D it gains too little even at the end.
template <int Dim>
constexpr int eager_iterations = Dim == 2 ? 0 : 3;

/// Adds the time of a scope to a kernel's, and makes it a section of the executor's recording.
class KernelTimer {
 public:
  KernelTimer(const runtime::Executor& executor, const char* kernel, double& seconds)
      : recording_(executor.recording()), seconds_(seconds) {
    if (recording_ != nullptr) recording_->begin_section(kernel);
  }
  KernelTimer(const KernelTimer&) = delete;
  KernelTimer& operator=(const KernelTimer&) = delete;
  ~KernelTimer() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (recording_ != nullptr) recording_->begin_section("other");
  }

 private:
  runtime::Recording* recording_;
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

template <int Dim>
Adapter<Dim>::Adapter(const runtime::Executor& executor, const AdaptOptions& options,
                      Mesh<Dim> mesh, Neighbours<Dim> neighbours,
                      const std::vector<Metric<Dim>>& metric_of)
    : executor_(executor),
      options_(options),
      mesh_(std::move(mesh)),
      background_(executor, mesh_, std::move(neighbours), metric_of) {
  parallel_for(executor_, mesh_.vertex_slots(), [&](std::size_t v) {
    const auto elements = mesh_.elements_of.of(static_cast<VertexId>(v));
    mesh_.site_of[v] = make_site(mesh_.site_of[v].position, metric_of[v]);
    mesh_.host_of[v] = elements.empty() ? 0 : elements.front();
  });
  update_shapes(executor_, mesh_);
  renumber(executor_, mesh_);
}

template <int Dim>
void Adapter<Dim>::run() {
  for (int eager = 0; report_.iterations < options_.iterations && eager <= eager_iterations<Dim>;) {
    ++report_.iterations;
    const bool calm = few(iterate());
    report_.converged = report_.converged || calm;
    // A mesh that comes adapted stays as it is.
    if (calm && (eager_ || report_.iterations == 1)) break;
    eager_ = report_.converged;
    eager += eager_ ? 1 : 0;
  }
  polish();
  renumber_mesh();
}

/// So few that another iteration is not worth it?
template <int Dim>
bool Adapter<Dim>::few(std::size_t changes) const {
  return static_cast<double>(changes) < 0.02 * static_cast<double>(element_count());
}

template <int Dim>
bool Adapter<Dim>::next_stage() {
  if (!options_.insert || stage_ + 1 == refinement_stages<Dim>().size()) return false;
  ++stage_;
  return true;
}

/// One round of the kernels that change the number of vertices. Refinement is one stage further in
/// each, or more if there is little else to do.
template <int Dim>
std::size_t Adapter<Dim>::iterate() {
  std::size_t changes = 0;
  if (options_.insert) {
    changes += coarsen();
    changes += refine();
  }
  while (few(changes) && next_stage()) changes += refine();
  next_stage();
  // In 2D order matters less than the time to restore it, unless much has changed.
  if (Dim == 3 || changes > element_count() / 20) renumber_mesh();
  if (options_.swap) changes += swap(8, Dim == 2 ? 0.9 : 0.8);
  if (options_.move) smooth(1, 0.3, true);
  return changes;
}

/// Raises quality without aiming at lengths any more.
template <int Dim>
void Adapter<Dim>::polish() {
  for (int pass = 0; pass < 2; ++pass) {
    if (options_.move) smooth(3, 0.5, true);
    if (options_.swap) swap(4, 0.95);
  }
  if (options_.move) smooth(2, 0.6, false);
}

/// Ends the mesh's epoch for a scan that starts now; returns when the same kernel's last one ended.
template <int Dim>
std::uint32_t Adapter<Dim>::end_epoch(std::uint32_t& seen) {
  return std::exchange(seen, mesh_.epoch++);
}

template <int Dim>
std::size_t Adapter<Dim>::coarsen() {
  const KernelTimer timer(executor_, "coarsen", report_.coarsen.seconds);
  std::size_t changes = 0;
  for (int sweep = 0; sweep < 8; ++sweep) {
    auto work = Coarsen<Dim>::crowded_vertices(executor_, mesh_, options_.rules.short_edge,
                                               end_epoch(seen_by_coarsen_));
    Rules rules = options_.rules;
    if (!eager_) rules.stretched_edge = rules.long_edge;
    Coarsen<Dim> op(mesh_, rules);
    const RoundsReport rounds = run_rounds(executor_, op, std::move(work), {.most_rounds = 30});
    add(report_.coarsen, rounds);
    changes += rounds.applied;
    if (rounds.applied < element_count() / 200) break;
  }
  tell("coarsen", changes);
  return changes;
}

template <int Dim>
std::size_t Adapter<Dim>::refine() {
  const KernelTimer timer(executor_, "refine", report_.refine.seconds);
  const double limit = options_.rules.long_edge * refinement_stages<Dim>()[stage_];
  auto work = Refine<Dim>::long_edges(executor_, mesh_, limit, end_epoch(seen_by_refine_));
  if (limit > options_.rules.long_edge) seen_by_refine_ = 0;  // shorter ones are for later
  Refine<Dim> op(mesh_, background_, options_.rules);
  const RoundsReport rounds = run_rounds(executor_, op, std::move(work));
  add(report_.refine, rounds);
  tell("refine", rounds.applied);
  return rounds.applied;
}

template <int Dim>
std::size_t Adapter<Dim>::swap(int sweeps, double below) {
  const KernelTimer timer(executor_, "swap", report_.swap.seconds);
  std::size_t changes = 0;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    auto work = Swap<Dim>::improvements(executor_, mesh_, end_epoch(seen_by_swap_), below);
    if (work.empty()) break;
    Swap<Dim> op(mesh_);
    const RoundsReport rounds = run_rounds(executor_, op, std::move(work));
    add(report_.swap, rounds);
    changes += rounds.applied;
    if (rounds.applied < element_count() / 500) break;
  }
  tell("swap", changes);
  return changes;
}

template <int Dim>
std::size_t Adapter<Dim>::smooth(int sweeps, double optimise_below, bool laplacian) {
  const KernelTimer timer(executor_, "smooth", report_.smooth.seconds);
  Smooth<Dim> op(mesh_, background_,
                 {.laplacian = laplacian, .optimise_below = optimise_below, .again = sweeps > 1});
  auto work = Smooth<Dim>::movable_vertices(executor_, mesh_, end_epoch(seen_by_smooth_));
  const RoundsReport rounds = run_rounds(executor_, op, std::move(work), {.most_rounds = sweeps});
  add(report_.smooth, rounds);
  tell("smooth", rounds.applied);
  return rounds.applied;
}

template <int Dim>
void Adapter<Dim>::renumber_mesh() {
  const KernelTimer timer(executor_, "renumber", report_.renumber_seconds);
  renumber(executor_, mesh_);
}

template <int Dim>
std::size_t Adapter<Dim>::element_count() const {
  return runtime::parallel_reduce(
      executor_, mesh_.element_slots(), std::size_t{0},
      [&](std::size_t e) { return std::size_t{mesh_.alive(static_cast<ElementId>(e))}; },
      [](std::size_t a, std::size_t b) { return a + b; });
}

template <int Dim>
void Adapter<Dim>::tell(const char* step, std::size_t changes) const {
  if (options_.progress) options_.progress({step, report_.iterations, changes});
}

template <int Dim>
void Adapter<Dim>::add(KernelReport& kernel, const RoundsReport& rounds) {
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
