#include "ductile/meshadapt/hessian_metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "core/first_bad.hpp"
#include "core/unit.hpp"
#include "ductile/meshadapt/error.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/interpolation.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The metrics to be scaled, their mesh, and the goal.
template <int Dim, int Space>
struct Scaling {
  std::vector<Metric<Space>>& metric_of;
  const FixedMesh<Dim, Space>& mesh;
  const ComplexityGoal& goal;
};

/// Grades the metrics until squared lengths exceed what they may be by this at most; returns the
/// complexity over the goal.
template <int Dim, int Space>
double take_graded(const Executor& executor, double tolerance, const Scaling<Dim, Space>& scaling) {
  limit_gradation(executor, scaling.metric_of, scaling.mesh,
                  {.factor = scaling.goal.gradation, .tolerance = tolerance});
  return complexity(executor, scaling.mesh, scaling.metric_of) / scaling.goal.complexity;
}

/// Multiplies graded metrics by one factor of 1 or more, so that they have the complexity. Sizes
/// grow by the less per unit of metric length, so that they stay graded.
template <int Dim, int Space>
double take_finer(const Executor& executor, double share, const Scaling<Dim, Space>& scaling) {
  const double factor = std::max(1.0, std::pow(1 / share, 2.0 / Dim));
  runtime::parallel_for(executor, scaling.metric_of.size(),
                        [&](std::size_t v) { scaling.metric_of[v] *= factor; });
  bound_sizes(executor, scaling.metric_of, {.smallest = scaling.goal.bounds.smallest});
  return complexity(executor, scaling.mesh, scaling.metric_of) / scaling.goal.complexity;
}

/// Looks for the factor by a secant of logarithms: grading adds the less, in proportion, the finer
/// the metric is, so the complexity grows with the factor at most to the power d / 2. Near the goal
/// is enough, and less than it is best: what is missing then takes no more grading.
template <int Dim, int Space>
MetricFit scale_graded(const Executor& executor, const Spectrum<Space>& spectrum, double start,
                       const Scaling<Dim, Space>& scaling) {
  constexpr int most_passes = 20;
  constexpr double near = 0.85, aim = 0.93, tolerance = 0.02, roughly = 0.05;
  constexpr double least_slope = 0.1, first_slope = Dim / 3.0, most_slope = 0.5 * Dim;
  double at = std::log(start), slope = first_slope, last_at = 0, last = 0;
  MetricFit best;
  for (int pass = 0; pass < most_passes && !best.reached; ++pass) {
    scaling.metric_of = spectrum.metrics(executor, std::exp(at));
    double share = take_graded(executor, roughly, scaling);
    const double found = std::log(share);
    if (share > near && share < 1 + tolerance) {
      share = take_graded(executor, GradationOptions{}.tolerance, scaling);
      share = take_finer(executor, share, scaling);
      best.reached = std::abs(share - 1) < tolerance;
    }
    best.complexity = share * scaling.goal.complexity;
    if (pass > 0 && at != last_at)
      slope = std::clamp((found - last) / (at - last_at), least_slope, most_slope);
    last_at = at;
    last = found;
    at += (std::log(aim) - found) / slope;
  }
  if (!best.reached)
    best.complexity =
        scaling.goal.complexity * take_graded(executor, GradationOptions{}.tolerance, scaling);
  return best;
}

/// Elements of an adapted mesh per unit of complexity. The mesh at hand tells K = N m^3 / C, where
/// m is the geometric mean of its edges' lengths. It counts the less, the more these differ, and
/// not at all where m is not nearly 1 (measured in docs/decisions/0052-*).
double elements_per_unit(const Executor& executor, const FixedMesh<3>& mesh,
                         const std::vector<Metric<3>>& metric_of, double complexity) {
  constexpr int Dim = 3;
  constexpr double little_spread = 0.27, much_spread = 0.37, most_offset = 0.22;
  using Sums = std::array<double, 2>;  // of logarithms of lengths, and of their squares
  const auto add = [](const Sums& a, const Sums& b) { return Sums{a[0] + b[0], a[1] + b[1]}; };
  const auto of_element = [&](std::size_t e) {
    Sums sums{};
    const Corners<Dim>& corner = mesh.corners_of[e];
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t j = i + 1; j <= Dim; ++j) {
        const Vector<Dim> edge = mesh.position_of[corner[j]] - mesh.position_of[corner[i]];
        const double length = 0.5 * (std::sqrt(squared_length(metric_of[corner[i]], edge)) +
                                     std::sqrt(squared_length(metric_of[corner[j]], edge)));
        const double logarithm = std::log(length);
        sums = add(sums, {logarithm, logarithm * logarithm});
      }
    return sums;
  };
  const Sums sums =
      runtime::parallel_reduce(executor, mesh.element_count(), Sums{}, of_element, add);
  const double count = static_cast<double>(mesh.element_count());
  const double edges = count * Dim * (Dim + 1) / 2;
  const double mean = sums[0] / edges, spread = std::sqrt(sums[1] / edges - mean * mean);
  const double average = 1 / complexity_of_elements(Dim, 1);
  if (!(std::abs(mean) < most_offset && spread < much_spread && complexity > 0)) return average;
  const double share = std::min((much_spread - spread) / (much_spread - little_spread), 1.0);
  return average + share * (count * std::exp(Dim * mean) / complexity - average);
}

void expect_goal(const ComplexityGoal& goal) {
  expect_bounds(goal.bounds);
  expect_gradation(goal.gradation);
  const auto sensible = [](double value) { return value >= 0 && std::isfinite(value); };
  if (sensible(goal.complexity) && sensible(goal.elements) &&
      (goal.complexity > 0) != (goal.elements > 0))
    return;
  throw InputError(
      "complexity: expected either it or the number of elements to be above 0, found " +
      number(goal.complexity) + " and " + number(goal.elements));
}

/// scale_to_complexity() with a goal of complexity.
template <int Dim, int Space>
MetricFit scale(const Executor& executor, std::vector<Metric<Space>>& metric_of,
                const FixedMesh<Dim, Space>& mesh, const ComplexityGoal& goal) {
  Spectrum<Space> spectrum{std::vector<PrincipalAxes<Space>>(metric_of.size()), goal.bounds};
  runtime::parallel_for(executor, metric_of.size(),
                        [&](std::size_t v) { spectrum.axes_of[v] = principal_axes(metric_of[v]); });
  const double now = complexity(executor, mesh, metric_of);
  const double start = now > 0 ? std::pow(goal.complexity / now, 2.0 / Dim) : 1;
  if (goal.gradation > 0)
    return scale_graded<Dim, Space>(executor, spectrum, start, {metric_of, mesh, goal});
  const auto scaled = [&](double factor) {
    if constexpr (Dim < Space)
      return complexity(executor, mesh, spectrum.metrics(executor, factor));
    else
      return spectrum.complexity(executor, mesh.share_of, factor);
  };
  const double factor = fitting_factor(scaled, goal.complexity, start);
  metric_of = spectrum.metrics(executor, factor);
  MetricFit fit;
  fit.complexity = scaled(factor);
  fit.reached = std::abs(fit.complexity / goal.complexity - 1) < 1e-6;
  return fit;
}

}  // namespace

double complexity_of_elements(int dimension, double elements) {
  if (dimension != 2 && dimension != 3)
    throw InputError("dimension: expected 2 or 3, found " + std::to_string(dimension));
  return elements / (dimension == 2 ? 2.25 : 9.5);
}

template <int Dim, int Space>
double complexity(const Executor& executor, const FixedMesh<Dim, Space>& mesh,
                  const std::vector<Metric<Space>>& metric_of) {
  expect_metric_everywhere(executor, metric_of, mesh.vertex_count(), "metric_of");
  const auto of_vertex = [&](std::size_t v) {
    return mesh.share_of[v] * std::sqrt(std::max(0.0, determinant(metric_of[v])));
  };
  const auto in_plane = [&](std::size_t e) {
    const double area = mesh.volume_of[e];
    if (!(area > 0)) return 0.0;
    double sum = 0;
    if constexpr (Dim < Space) {
      const Vector<3> normal = unit(facet_normal(mesh.points(static_cast<ElementId>(e))));
      for (const VertexId v : mesh.corners_of[e])
        sum += area / 3 * std::exp(log_density_in_plane(metric_of[v], normal));
    }
    return sum;
  };
  const auto add = std::plus<>();
  return Dim < Space ? runtime::parallel_reduce(executor, mesh.element_count(), 0.0, in_plane, add)
                     : runtime::parallel_reduce(executor, metric_of.size(), 0.0, of_vertex, add);
}

template <int Dim, int Space>
MetricFit scale_to_complexity(const Executor& executor, std::vector<Metric<Space>>& metric_of,
                              const FixedMesh<Dim, Space>& mesh, const ComplexityGoal& goal) {
  expect_metric_everywhere(executor, metric_of, mesh.vertex_count(), "metric_of");
  expect_goal(goal);
  ComplexityGoal in_units = goal;
  double per_unit = 1 / complexity_of_elements(Dim, 1);
  if (goal.elements > 0) in_units.complexity = goal.elements / per_unit;
  MetricFit fit = scale(executor, metric_of, mesh, in_units);
  if constexpr (Dim == 3) per_unit = elements_per_unit(executor, mesh, metric_of, fit.complexity);
  if (Dim == 3 && goal.elements > 0) {
    in_units.complexity = goal.elements / per_unit;
    fit = scale(executor, metric_of, mesh, in_units);
  }
  fit.elements = per_unit * fit.complexity;
  return fit;
}

template double complexity(const Executor&, const FixedMesh<2>&, const std::vector<Metric<2>>&);
template double complexity(const Executor&, const FixedMesh<2, 3>&, const std::vector<Metric<3>>&);
template double complexity(const Executor&, const FixedMesh<3>&, const std::vector<Metric<3>>&);
template MetricFit scale_to_complexity(const Executor&, std::vector<Metric<2>>&,
                                       const FixedMesh<2>&, const ComplexityGoal&);
template MetricFit scale_to_complexity(const Executor&, std::vector<Metric<3>>&,
                                       const FixedMesh<2, 3>&, const ComplexityGoal&);
template MetricFit scale_to_complexity(const Executor&, std::vector<Metric<3>>&,
                                       const FixedMesh<3>&, const ComplexityGoal&);

}  // namespace ductile::meshadapt
