#include "ductile/meshadapt/hessian_metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// What is scaled: the metrics on their mesh, and where to.
template <int Dim>
struct Scaling {
  std::vector<Metric<Dim>>& metric_of;
  const FixedMesh<Dim>& mesh;
  const ComplexityGoal& goal;
};

/// The metrics of the spectrum times a factor, graded; returns their complexity.
template <int Dim>
double take_graded(const Executor& executor, const Spectrum<Dim>& spectrum, double factor,
                   const Scaling<Dim>& scaling) {
  scaling.metric_of = spectrum.metrics(executor, factor);
  limit_gradation(executor, scaling.metric_of, scaling.mesh, {.factor = scaling.goal.gradation});
  return complexity(executor, scaling.mesh, scaling.metric_of);
}

/// Looks for the factor by a secant of logarithms: grading adds the less, in proportion, the finer
/// the metric is, so the complexity grows with the factor at most to the power d / 2.
template <int Dim>
MetricFit scale_graded(const Executor& executor, const Spectrum<Dim>& spectrum, double start,
                       const Scaling<Dim>& scaling) {
  constexpr int most_passes = 20;
  constexpr double tolerance = 0.02, least_slope = 0.1, most_slope = 0.5 * Dim;
  const double goal = std::log(scaling.goal.complexity);
  double at = std::log(start), slope = most_slope, last_at = 0, last = 0;
  double best_at = at, least_miss = std::numeric_limits<double>::infinity();
  MetricFit fit;
  for (int pass = 0; pass < most_passes && !fit.reached; ++pass) {
    fit.complexity = take_graded(executor, spectrum, std::exp(at), scaling);
    fit.reached = std::abs(fit.complexity / scaling.goal.complexity - 1) < tolerance;
    const double found = std::log(fit.complexity);
    if (pass > 0 && at != last_at)
      slope = std::clamp((found - last) / (at - last_at), least_slope, most_slope);
    last_at = at;
    last = found;
    if (std::abs(goal - found) < least_miss) {
      least_miss = std::abs(goal - found);
      best_at = at;
    }
    at += (goal - found) / slope;
  }
  if (best_at != last_at)
    fit.complexity = take_graded(executor, spectrum, std::exp(best_at), scaling);
  return fit;
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
