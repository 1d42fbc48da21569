#include "ductile/meshadapt/hessian_metric.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The metrics to be scaled, their mesh, and the goal.
template <int Dim>
struct Scaling {
  std::vector<Metric<Dim>>& metric_of;
  const FixedMesh<Dim>& mesh;
  const ComplexityGoal& goal;
};

/// Grades the metrics until squared lengths exceed what they may be by this at most; returns the
/// complexity over the goal.
template <int Dim>
double take_graded(const Executor& executor, double tolerance, const Scaling<Dim>& scaling) {
  limit_gradation(executor, scaling.metric_of, scaling.mesh,
                  {.factor = scaling.goal.gradation, .tolerance = tolerance});
  return complexity(executor, scaling.mesh, scaling.metric_of) / scaling.goal.complexity;
}

/// Multiplies graded metrics by one factor of 1 or more, so that they have the complexity. Sizes
/// grow by the less per unit of metric length, so that they stay graded.
template <int Dim>
double take_finer(const Executor& executor, double share, const Scaling<Dim>& scaling) {
  const double factor = std::max(1.0, std::pow(1 / share, 2.0 / Dim));
  runtime::parallel_for(executor, scaling.metric_of.size(),
                        [&](std::size_t v) { scaling.metric_of[v] *= factor; });
  bound_sizes(executor, scaling.metric_of, {.smallest = scaling.goal.bounds.smallest});
  return complexity(executor, scaling.mesh, scaling.metric_of) / scaling.goal.complexity;
}

/// Looks for the factor by a secant of logarithms: grading adds the less, in proportion, the finer
/// the metric is, so the complexity grows with the factor at most to the power d / 2. Near the goal
/// is enough, and less than it is best: what is missing then takes no more grading.
template <int Dim>
MetricFit scale_graded(const Executor& executor, const Spectrum<Dim>& spectrum, double start,
                       const Scaling<Dim>& scaling) {
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

}  // namespace

double complexity_of_elements(int dimension, double elements) {
  if (dimension != 2 && dimension != 3)
    throw InputError("dimension: expected 2 or 3, found " + std::to_string(dimension));
  return elements / (dimension == 2 ? 2.25 : 9.5);
}

template <int Dim>
double complexity(const Executor& executor, const FixedMesh<Dim>& mesh,
                  const std::vector<Metric<Dim>>& metric_of) {
  expect_metric_everywhere(executor, metric_of, mesh.vertex_count(), "metric_of");
  return runtime::parallel_reduce(
      executor, metric_of.size(), 0.0,
      [&](std::size_t v) {
        return mesh.share_of[v] * std::sqrt(std::max(0.0, determinant(metric_of[v])));
      },
      [](double a, double b) { return a + b; });
}

template <int Dim>
MetricFit scale_to_complexity(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                              const FixedMesh<Dim>& mesh, const ComplexityGoal& goal) {
  expect_metric_everywhere(executor, metric_of, mesh.vertex_count(), "metric_of");
  expect_bounds(goal.bounds);
  expect_gradation(goal.gradation);
  if (!(goal.complexity > 0) || !std::isfinite(goal.complexity))
    throw InputError("complexity: expected a number above 0, found " + number(goal.complexity));
  Spectrum<Dim> spectrum{std::vector<PrincipalAxes<Dim>>(metric_of.size()), goal.bounds};
  runtime::parallel_for(executor, metric_of.size(),
                        [&](std::size_t v) { spectrum.axes_of[v] = principal_axes(metric_of[v]); });
  const double now = complexity(executor, mesh, metric_of);
  const double start = now > 0 ? std::pow(goal.complexity / now, 2.0 / Dim) : 1;
  if (goal.gradation > 0) return scale_graded(executor, spectrum, start, {metric_of, mesh, goal});
  const double factor = fitting_factor(
      [&](double f) { return spectrum.complexity(executor, mesh, f); }, goal.complexity, start);
  metric_of = spectrum.metrics(executor, factor);
  MetricFit fit;
  fit.complexity = spectrum.complexity(executor, mesh, factor);
  fit.reached = std::abs(fit.complexity / goal.complexity - 1) < 1e-6;
  return fit;
}

template double complexity(const Executor&, const FixedMesh<2>&, const std::vector<Metric<2>>&);
template double complexity(const Executor&, const FixedMesh<3>&, const std::vector<Metric<3>>&);
template MetricFit scale_to_complexity(const Executor&, std::vector<Metric<2>>&,
                                       const FixedMesh<2>&, const ComplexityGoal&);
template MetricFit scale_to_complexity(const Executor&, std::vector<Metric<3>>&,
                                       const FixedMesh<3>&, const ComplexityGoal&);

}  // namespace ductile::meshadapt
