#include "fingering/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/transfer.hpp"

namespace ductile::paper {

namespace {

/// Adds the duration of a block to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(Seconds& sum) : sum_(sum) {}
  ~Stopwatch() {
    sum_.wall += std::chrono::duration<double>(Clock::now() - start_).count();
    sum_.processor += static_cast<double>(std::clock() - processor_start_) / CLOCKS_PER_SEC;
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  Seconds& sum_;
  Clock::time_point start_ = Clock::now();
  std::clock_t processor_start_ = std::clock();
};

using Metric = meshadapt::Metric<2>;
using Point = meshadapt::Vector<2>;

/// The faster and smoother method, because fields are noisy where the mesh has just been changed.
constexpr auto recovery = meshadapt::Recovery::double_projection;

}  // namespace

Simulation::Simulation(const runtime::Executor& executor, const Fluids& fluids, const AnyMesh& mesh,
                       Start start)
    : executor_(executor), fluids_(fluids) {
  take_mesh(mesh);
  sample(start);
}

void Simulation::take_mesh(AnyMesh mesh) {
  mesh_ = std::move(mesh);
  dual_ = std::make_unique<DualMesh>(make_dual_mesh(executor_, mesh_));
  solver_ = std::make_unique<PressureSolver>(*dual_);
  flow_is_current_ = false;
}

void Simulation::sample(Start start) {
  saturation_of_.clear();
  for (const auto& position : dual_->mesh.position_of) saturation_of_.push_back(start(position));
  start_mass_ = mass();
  flow_is_current_ = false;
}

void Simulation::find_flow() {
  if (flow_is_current_) return;
  const Stopwatch stopwatch(timings_.pressure);
  flow_ = solver_->solve(fluids_, saturation_of_);
  flow_is_current_ = true;
}

// ---- Time ----

void Simulation::advance(double interval) {
  find_flow();
  {
    const Stopwatch stopwatch(timings_.transport);
    Transport transport(executor_, *dual_, fluids_, flow_);
    steps_ += transport.advance(saturation_of_, ledger_, interval);
  }
  flow_is_current_ = false;
  time_ += interval;
  triangle_time_ += interval * static_cast<double>(mesh_.triangles.size());
  watch_bounds();
}

void Simulation::watch_bounds() {
  const auto [low, high] = std::minmax_element(saturation_of_.begin(), saturation_of_.end());
  overshoot_ = std::max({overshoot_, -*low, *high - 1});
}

double Simulation::integral(const std::vector<double>& value_of) const {
  return meshadapt::integral<2>(executor_, dual_->mesh, value_of);
}

double Simulation::mass_error() const {
  const double expected = start_mass_ + ledger_.injected - ledger_.produced;
  return (mass() - expected) / expected;
}

// ---- The mesh ----

std::vector<Metric> Simulation::wanted_metric(const AdaptGoal& goal) {
  find_flow();
  const Stopwatch stopwatch(timings_.adaptation);
  const auto metric_for = [&](const std::vector<double>& value_of, double error) {
    const auto hessian_of =
        meshadapt::recover_hessian<2>(executor_, dual_->mesh, value_of, recovery);
    return meshadapt::hessian_metric<2>(
               executor_, dual_->mesh, hessian_of,
               {.error = error,
                .bounds = {.smallest = goal.smallest_size, .largest = goal.largest_size}})
        .metric_of;
  };
  const std::vector<double>& pressure_of = flow_.pressure_of;
  const double highest = *std::max_element(pressure_of.begin(), pressure_of.end());
  const std::vector<Metric> now_of = metric_for(saturation_of_, goal.saturation_error);
  std::vector<Metric> metric_of = metric_for(pressure_of, goal.pressure_error * highest);
  meshadapt::intersect(executor_, metric_of, now_of);
  if (goal.ahead > 0)
    for (const double time : {goal.ahead / 2, goal.ahead})
      meshadapt::intersect(executor_, metric_of, carried(now_of, time));
  return metric_of;
}

/// The metric at each vertex after the current flow has carried it for this time: the metric at the
/// point where the flow to the vertex starts.
std::vector<Metric> Simulation::carried(const std::vector<Metric>& metric_of, double time) const {
  const auto slope_of =
      meshadapt::recover_gradient<2>(executor_, dual_->mesh, flow_.pressure_of, recovery);
  std::vector<double> upstream = mesh_.coordinates;
  for (VertexId v = 0; v < slope_of.size(); ++v) {
    const Point back = (time * mobility(fluids_, saturation_of_[v])) * slope_of[v];
    for (std::size_t axis = 0; axis < 2; ++axis) upstream[2 * v + axis] += back[axis];
  }
  const meshadapt::AnyField now = meshadapt::symmetric_field<2>(executor_, metric_of, "metric");
  return meshadapt::tensors_of<2>(
      executor_,
      meshadapt::interpolate_at(executor_, {.mesh = mesh_, .field = now}, upstream).field);
}

AnyMesh Simulation::adapted_mesh(const AdaptGoal& goal) {
  const std::vector<Metric> metric_of = wanted_metric(goal);
  const Stopwatch stopwatch(timings_.adaptation);
  const meshadapt::AnyField metric = meshadapt::symmetric_field<2>(executor_, metric_of, "metric");
  return meshadapt::adapt(executor_, mesh_, metric,
                          {.iterations = 3,  // the mesh was good a moment ago
                           .smallest_size = goal.smallest_size,
                           .largest_size = goal.largest_size,
                           .gradation = 1.5})
      .mesh;
}

void Simulation::adapt_to_start(const AdaptGoal& goal, Start start) {
  constexpr int rounds = 5;
  for (int i = 0; i < rounds; ++i) {
    take_mesh(adapted_mesh(goal));
    sample(start);
  }
}

void Simulation::adapt(const AdaptGoal& goal) {
  AnyMesh next = adapted_mesh(goal);
  ++adaptations_;
  const Stopwatch stopwatch(timings_.transfer);
  const double before = mass();
  const meshadapt::AnyField field = meshadapt::scalar_field(2, std::move(saturation_of_));
  saturation_of_ =
      meshadapt::project_field(executor_, {.mesh = mesh_, .field = field}, next).field.values;
  take_mesh(std::move(next));
  transfer_error_ = std::max(transfer_error_, std::abs(mass() / before - 1));
  watch_bounds();
}

}  // namespace ductile::paper
