#include "march.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "ductile/meshadapt/box_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "solution.hpp"

namespace ductile::paper {

using meshadapt::AnyMesh;

namespace {

void add(KernelSeconds& sum, const FollowedMesh& step) {
  const meshadapt::AdaptReport& report = step.adapted.report;
  sum.coarsen += report.coarsen.seconds;
  sum.swap += report.swap.seconds;
  sum.refine += report.refine.seconds;
  sum.smooth += report.smooth.seconds;
  sum.other += report.total_seconds - report.coarsen.seconds - report.swap.seconds -
               report.refine.seconds - report.smooth.seconds;
  sum.metric += step.metric_seconds;
}

}  // namespace

FollowedMesh follow(const runtime::Executor& executor, const AnyMesh& mesh, const MeshGoal& goal,
                    double phase) {
  const auto start = std::chrono::steady_clock::now();
  meshadapt::SolutionMetricOptions options;
  options.goal.complexity = meshadapt::complexity_of_elements(mesh.dimension, goal.elements);
  options.goal.norm = 1;  // in which a jump does not spoil the rate
  options.goal.bounds = {goal.smallest, goal.largest, goal.anisotropy};
  const meshadapt::SolutionMetric metric =
      meshadapt::solution_metric(executor, mesh, sampled_solution(mesh, phase), options);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {meshadapt::adapt(executor, mesh, metric.metric), taken.count()};
}

MarchReport march(const runtime::Executor& executor, AnyMesh mesh, const March& march) {
  for (int i = 0; i < 3; ++i) mesh = follow(executor, mesh, march.goal, 0).adapted.mesh;
  MarchReport report{.steps = march.steps, .seconds = {}};
  for (int step = 0; step < march.steps; ++step) {
    const double phase = 2 * std::numbers::pi * (step + 1) / march.steps;
    FollowedMesh followed = follow(executor, mesh, march.goal, phase);
    add(report.seconds, followed);
    mesh = std::move(followed.adapted.mesh);
    report.mean_elements += static_cast<double>(element_count(mesh)) / march.steps;
    if (march.look) march.look(step, phase, mesh);
  }
  return report;
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

AnyMesh start_mesh_of(int dimension, int cells) {
  return dimension == 2 ? meshadapt::rectangle_mesh({1, 1}, {cells, cells})
                        : meshadapt::box_mesh({1, 1, 1}, {cells, cells, cells});
}

AnyMesh start_mesh(int dimension, double elements) {
  const double cells = dimension == 2 ? std::sqrt(elements / 2) : std::cbrt(elements / 6);
  return start_mesh_of(dimension, std::max(2, static_cast<int>(cells)));
}

}  // namespace ductile::paper
