#include "march.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "solution.hpp"

namespace ductile::paper {

using meshadapt::AdaptedMesh;
using meshadapt::AnyMesh;

namespace {

void add(TimedSteps& sum, const FollowedMesh& step) {
  const meshadapt::AdaptReport& report = step.adapted.report;
  ++sum.steps;
  sum.seconds.other += report.total_seconds;
  for (std::size_t k = 0; k < meshadapt::kernels.size(); ++k) {
    const double seconds = (report.*meshadapt::kernels[k].report).seconds;
    sum.seconds.kernels[k] += seconds;
    sum.seconds.other -= seconds;
  }
  sum.seconds.metric += step.metric_seconds;
}

template <class Item>
bool same_bytes(const std::vector<Item>& a, const std::vector<Item>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0);
}

bool identical(const AdaptedMesh& a, const AdaptedMesh& b) {
  return same_bytes(a.mesh.coordinates, b.mesh.coordinates) &&
         same_bytes(a.mesh.edges.vertices, b.mesh.edges.vertices) &&
         same_bytes(a.mesh.triangles.vertices, b.mesh.triangles.vertices) &&
         same_bytes(a.mesh.tetrahedra.vertices, b.mesh.tetrahedra.vertices) &&
         same_bytes(a.metric.values, b.metric.values);
}

/// Is this step one of the `timed` steps, which are spread evenly?
bool is_timed(int step, const March& march) {
  return (step + 1) * march.timed / march.until > step * march.timed / march.until;
}

}  // namespace

FollowedMesh follow(const runtime::Executor& executor, const AnyMesh& mesh, const MeshGoal& goal,
                    double phase) {
  const auto start = std::chrono::steady_clock::now();
  meshadapt::SolutionMetricOptions options;
  options.goal.complexity = meshadapt::complexity_of_elements(mesh.dimension, goal.elements);
  options.goal.norm = 1;  // in this norm a jump does not spoil the rate
  options.goal.bounds = {goal.smallest, goal.largest, goal.anisotropy};
  const meshadapt::SolutionMetric metric =
      meshadapt::solution_metric(executor, mesh, sampled_solution(executor, mesh, phase), options);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return {meshadapt::adapt(executor, mesh, metric.metric), taken.count()};
}

AnyMesh fitted_mesh(const runtime::Executor& executor, AnyMesh mesh, MeshGoal& goal,
                    const std::vector<double>& phases) {
  const double wanted = goal.elements;
  for (const double phase : phases) {
    mesh = follow(executor, mesh, goal, phase).adapted.mesh;
    // After a large step in phase, a single mesh is not representative.
    const double ratio = goal.elements / static_cast<double>(element_count(mesh));
    goal.elements = wanted * std::clamp(ratio, 0.7, 1.4);
  }
  return mesh;
}

MarchReport march(const runtime::Executor& executor, AnyMesh mesh, const March& march) {
  const double phase_step = 2 * std::numbers::pi / march.steps;
  MeshGoal goal = march.goal;
  mesh = fitted_mesh(executor, std::move(mesh), goal, {-2 * phase_step, -phase_step, 0});
  MarchReport report{.all = {.threads = executor.threads()}};
  for (const int threads : march.threads) report.timed.push_back({.threads = threads});
  report.timed.push_back({.threads = executor.threads()});
  for (int step = 0; step < march.until; ++step) {
    const double phase = phase_step * (step + 1);
    FollowedMesh followed = follow(executor, mesh, goal, phase);
    add(report.all, followed);
    if (is_timed(step, march)) {
      add(report.timed.back(), followed);
      for (std::size_t i = 0; i < march.threads.size(); ++i) {
        const runtime::Executor others({.threads = march.threads[i]});
        const FollowedMesh again = follow(others, mesh, goal, phase);
        add(report.timed[i], again);
        report.identical = report.identical && identical(again.adapted, followed.adapted);
      }
    }
    mesh = std::move(followed.adapted.mesh);
    report.mean_elements += static_cast<double>(element_count(mesh)) / march.until;
    if (march.look) march.look(step, phase, mesh);
  }
  return report;
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

AnyMesh start_mesh_of(int dimension, int cells) {
  return dimension == 2 ? meshadapt::box_mesh<2>({1, 1}, {cells, cells})
                        : meshadapt::box_mesh({1, 1, 1}, {cells, cells, cells});
}

AnyMesh start_mesh(int dimension, double elements) {
  const double cells = dimension == 2 ? std::sqrt(elements / 2) : std::cbrt(elements / 6);
  return start_mesh_of(dimension, std::max(2, static_cast<int>(cells)));
}

}  // namespace ductile::paper
