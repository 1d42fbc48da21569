#include "ductile/meshadapt/hessian_metric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/box.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/wording.hpp"
#include "metric/charts.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;
using runtime::parallel_reduce;

namespace {

/// Eigenvalues below this share of the largest anywhere count as this share.
constexpr double least_curvature = 1e-12;

/// More lets the error of a solver grow from one mesh to the next (docs/decisions/0052-*).
constexpr double default_anisotropy = 30;

double largest_of(double a, double b) { return std::max(a, b); }

void expect_options(const HessianMetricOptions& options) {
  if (!(options.norm >= 1))
    throw InputError("metric of a Hessian: expected an L^p norm with p of 1 or more, found " +
                     number(options.norm));
  const auto sensible = [](double goal) { return goal >= 0 && std::isfinite(goal); };
  const std::array goals{options.complexity, options.elements, options.error};
  if (!std::all_of(goals.begin(), goals.end(), sensible) ||
      std::count_if(goals.begin(), goals.end(), [](double goal) { return goal > 0; }) != 1)
    throw InputError(
        "metric of a Hessian: expected one of complexity, elements and error to be above 0");
  expect_bounds(options.bounds);
}

/// Length of the diagonal of the box around the mesh.
template <int Dim, int Space>
double extent(const Executor& executor, const FixedMesh<Dim, Space>& mesh) {
  const Box<Space> box = parallel_reduce(
      executor, mesh.vertex_count(), Box<Space>::empty(),
      [&](std::size_t v) {
        return Box<Space>{mesh.position_of[v], mesh.position_of[v]};
      },
      [](const Box<Space>& a, const Box<Space>& b) { return join(a, b); });
  return norm(box.high - box.low);
}

/// The bounds that hold, those included that are not given.
template <int Dim, int Space>
SizeBounds bounds_in_force(const Executor& executor, const FixedMesh<Dim, Space>& mesh,
                           SizeBounds bounds) {
  if (bounds.anisotropy == 0) bounds.anisotropy = default_anisotropy;
  if (bounds.largest == 0) bounds.largest = std::max(extent(executor, mesh), bounds.smallest);
  return bounds;
}

/// The L^p norm of what has these values at the vertices, none below 0, over the largest of them so
/// that no power of it leaves the range of numbers.
double norm_of(const Executor& executor, const std::vector<double>& share_of,
               const std::vector<double>& value_of, double norm) {
  const double most = parallel_reduce(
      executor, value_of.size(), 0.0, [&](std::size_t v) { return value_of[v]; }, largest_of);
  if (most == 0 || std::isinf(norm)) return most;
  const double sum = parallel_reduce(
      executor, value_of.size(), 0.0,
      [&](std::size_t v) { return share_of[v] * std::pow(value_of[v] / most, norm); },
      std::plus<>());
  return most * std::pow(sum, 1 / norm);
}

template <int Dim, int Space>
class HessianMetric {
 public:
  HessianMetric(const Executor& executor, const FixedMesh<Dim, Space>& mesh,
                const HessianMetricOptions& options)
      : executor_(executor), mesh_(mesh), options_(options) {
    options_.bounds = bounds_in_force(executor, mesh, options_.bounds);
  }

  FittedMetric<Dim> fit(const std::vector<Metric<Dim>>& hessian_of) {
    take_curvatures(hessian_of);
    normalise();
    const double wanted = options_.complexity;
    const double plain = spectrum_.complexity(executor_, mesh_.share_of, 1);
    spectrum_.bounds = options_.bounds;
    double factor = 0;
    if (wanted > 0)
      factor = fitting_factor(
          [&](double f) { return spectrum_.complexity(executor_, mesh_.share_of, f); }, wanted,
          std::pow(wanted / plain, 2.0 / Dim));
    else
      factor = fitting_factor([&](double f) { return 1 / error(f); }, 1 / options_.error, 1);
    FittedMetric<Dim> result{spectrum_.metrics(executor_, factor), {}};
    result.fit.complexity = spectrum_.complexity(executor_, mesh_.share_of, factor);
    result.fit.elements = result.fit.complexity / complexity_of_elements(Dim, 1);
    result.fit.error = error(factor);
    result.fit.reached = wanted > 0 ? std::abs(result.fit.complexity / wanted - 1) < 1e-6
                                    : result.fit.error <= options_.error * (1 + 1e-6);
    return result;
  }

 private:
  void take_curvatures(const std::vector<Metric<Dim>>& hessian_of) {
    expect_at_each_vertex("hessian_of: expected a tensor", mesh_.vertex_count(), hessian_of.size());
    const std::size_t bad = first_bad(executor_, hessian_of.size(), [&](std::size_t v) {
      const auto& m = hessian_of[v].m;
      return !std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); });
    });
    if (bad != no_index)
      refuse("metric of a Hessian: expected finite numbers, found others at " +
             entry("hessian_of", "vertex", bad));
    spectrum_.axes_of.resize(hessian_of.size());
    curvature_of_.resize(hessian_of.size());
    parallel_for(executor_, hessian_of.size(), [&](std::size_t v) {
      spectrum_.axes_of[v] = principal_axes(hessian_of[v]);
      for (std::size_t i = 0; i < Dim; ++i)
        curvature_of_[v][i] = std::abs(spectrum_.axes_of[v].value[i]);
    });
  }

  /// Eigenvalues of det|H|^(-1/(2p+d)) |H|, of an H that is scaled to 1 and nowhere singular.
  void normalise() {
    const double largest = parallel_reduce(
        executor_, curvature_of_.size(), 0.0,
        [&](std::size_t v) {
          return *std::max_element(curvature_of_[v].begin(), curvature_of_[v].end());
        },
        largest_of);
    const double exponent = -1 / (2 * options_.norm + Dim);
    const SizeBounds only_anisotropy{.anisotropy = options_.bounds.anisotropy};
    parallel_for(executor_, curvature_of_.size(), [&](std::size_t v) {
      auto& value = spectrum_.axes_of[v].value;
      for (std::size_t i = 0; i < Dim; ++i)
        value[i] = largest > 0 ? std::max(curvature_of_[v][i] / largest, least_curvature) : 1;
      value = bounded(value, only_anisotropy);
      double determinant = 1;
      for (const double h : value) determinant *= h;
      const double density = std::pow(determinant, exponent);
      for (double& h : value) h *= density;
    });
  }

  /// The L^p norm of trace(M^-1 |H|) / (4 (d + 2)).
  double error(double factor) const {
    const auto at = [&](std::size_t v) {
      if (!(mesh_.share_of[v] > 0)) return 0.0;
      const auto value = spectrum_.scaled(v, factor);
      double trace = 0;
      for (std::size_t i = 0; i < Dim; ++i) trace += curvature_of_[v][i] / value[i];
      return trace / (4 * (Dim + 2));
    };
    std::vector<double> error_at(curvature_of_.size());
    parallel_for(executor_, error_at.size(), [&](std::size_t v) { error_at[v] = at(v); });
    return norm_of(executor_, mesh_.share_of, error_at, options_.norm);
  }

  const Executor& executor_;
  const FixedMesh<Dim, Space>& mesh_;
  HessianMetricOptions options_;
  std::vector<std::array<double, Dim>> curvature_of_;  // [vertex], |eigenvalues| of the Hessian
  Spectrum<Dim> spectrum_;
};

/// The metric for a goal of elements has the complexity of so many on an average mesh.
template <int Dim, int Space>
FittedMetric<Dim> fit(const Executor& executor, const FixedMesh<Dim, Space>& mesh,
                      const std::vector<Metric<Dim>>& hessian_of, HessianMetricOptions options) {
  expect_options(options);
  if (options.elements > 0) {
    options.complexity = complexity_of_elements(Dim, options.elements);
    options.elements = 0;
  }
  return HessianMetric<Dim, Space>(executor, mesh, options).fit(hessian_of);
}

/// True if second derivatives are only the rounding of the values they come from: those of a
/// linear function are, and a metric of them would be noise. A Hessian H says that the function
/// departs by d'Hd / 8 from its interpolant along an edge d. Values are rounded by eps/2 of the
/// largest, more where they are sums, and fits to them amplify that, most where surroundings are
/// one-sided. Shorter edges near by make the noise of longer ones, as rounding over the square of
/// an edge does.
template <int Dim, int Space>
class Roundoff {
 public:
  Roundoff(const Charts<Dim, Space>& charts, const std::vector<double>& value_of)
      : charts_(charts), mesh_(charts.mesh()), value_of_(value_of) {}

  bool explains(const Executor& executor, const std::vector<Metric<Dim>>& hessian_of) const {
    constexpr double amplified = 100 * std::numeric_limits<double>::epsilon();
    const double largest_value = parallel_reduce(
        executor, value_of_.size(), 0.0, [&](std::size_t v) { return std::abs(value_of_[v]); },
        largest_of);
    std::vector<double> shortest_at(mesh_.vertex_count());  // squared
    parallel_for(executor, shortest_at.size(),
                 [&](std::size_t v) { shortest_at[v] = shortest(v); });
    const double departure = parallel_reduce(
        executor, hessian_of.size(), 0.0,
        [&](std::size_t v) { return seen_at(v, hessian_of[v], shortest_at); }, largest_of);
    return departure <= amplified * largest_value;
  }

 private:
  template <class Visit>
  void each_edge(std::size_t v, Visit&& visit) const {
    for (const ElementId e : mesh_.elements_of(static_cast<VertexId>(v)))
      for (const VertexId other : mesh_.corners_of[e])
        if (other != v) visit(other, charts_.offset(static_cast<VertexId>(v), other));
  }

  double shortest(std::size_t v) const {
    double least = std::numeric_limits<double>::infinity();
    each_edge(v, [&](VertexId, const Vector<Dim>& d) { least = std::min(least, dot(d, d)); });
    return least;
  }

  /// The largest |d'Hd|, as on a mesh whose edges are as short as those near by.
  double seen_at(std::size_t v, const Metric<Dim>& hessian,
                 const std::vector<double>& shortest_at) const {
    double most = 0, nearby = shortest_at[v];
    each_edge(v, [&](VertexId other, const Vector<Dim>& d) {
      most = std::max(most, std::abs(squared_length(hessian, d)));
      nearby = std::min(nearby, shortest_at[other]);
    });
    return most > 0 ? most * (nearby / shortest_at[v]) : 0;
  }

  const Charts<Dim, Space>& charts_;
  const FixedMesh<Dim, Space>& mesh_;
  const std::vector<double>& value_of_;
};

/// trace(M^-1 |H|) / (4 (d + 2)); |H| is absolute(H).
template <int Dim>
double local_error(const Metric<Dim>& metric, const Metric<Dim>& hessian) {
  const PrincipalAxes<Dim> axes = principal_axes(metric);
  const Metric<Dim> curvature = absolute(hessian);
  double trace = 0;
  for (std::size_t i = 0; i < Dim; ++i)
    trace += squared_length(curvature, axes.vector[i]) / axes.value[i];
  return trace / (4 * (Dim + 2));
}

/// HessianMetric::error() for any metrics.
template <int Dim>
double error_of(const Executor& executor, const std::vector<double>& share_of,
                const std::vector<Metric<Dim>>& metric_of,
                const std::vector<Metric<Dim>>& hessian_of, double norm) {
  std::vector<double> error_at(metric_of.size());
  parallel_for(executor, error_at.size(), [&](std::size_t v) {
    error_at[v] = share_of[v] > 0 ? local_error(metric_of[v], hessian_of[v]) : 0;
  });
  return norm_of(executor, share_of, error_at, norm);
}

template <int Dim, int Space>
std::vector<Metric<Dim>> hessian_in(const Executor& executor, const Charts<Dim, Space>& charts,
                                    const std::vector<double>& value_of, Recovery recovery) {
  if constexpr (Dim == Space)
    return recover_hessian<Dim>(executor, charts.mesh(), value_of, recovery);
  if (recovery == Recovery::double_projection)
    throw InputError(
        "metric of a solution on a surface: expected derivatives by least squares, found double "
        "projection");
  return fitted_hessian(executor, charts, value_of);
}

template <int Dim, int Space = Dim>
SolutionMetric solution_metric_in(const Executor& executor, const AnyMesh& any,
                                  const AnyField& field, const SolutionMetricOptions& options) {
  expect_gradation(options.gradation);
  expect_finite(executor, field);  // a Hessian spreads it, so another vertex would be named
  const auto mesh = make_fixed_mesh<Dim, Space>(executor, any);
  const Charts<Dim, Space> charts(executor, mesh);
  const auto& nodes = charts.mesh();
  const std::size_t stride = stride_of(field);
  FittedMetric<Dim> all;  // at the nodes
  all.fit.reached = true;
  std::vector<std::vector<Metric<Dim>>> hessians;  // [component][node]
  std::vector<double> value_of(nodes.vertex_count());
  for (std::size_t component = 0; component < stride; ++component) {
    parallel_for(executor, value_of.size(), [&](std::size_t n) {
      value_of[n] = field.values[charts.vertex(static_cast<VertexId>(n)) * stride + component];
    });
    hessians.push_back(hessian_in(executor, charts, value_of, options.recovery));
    if (Roundoff<Dim, Space>(charts, value_of).explains(executor, hessians.back()))
      hessians.back().assign(nodes.vertex_count(), Metric<Dim>{});
    FittedMetric<Dim> one = fit(executor, nodes, hessians.back(), options.goal);
    all.fit.reached = all.fit.reached && one.fit.reached;
    if (component == 0)
      all.metric_of = std::move(one.metric_of);
    else
      intersect(executor, all.metric_of, one.metric_of);
  }
  MetricFit found = all.fit;
  std::vector<Metric<Space>> metric_of = charts.lifted(executor, std::move(all.metric_of));
  const bool changed = stride > 1 || options.gradation > 0 || Dim < Space;
  if (options.goal.elements > 0 || (options.goal.complexity > 0 && changed))
    found = scale_to_complexity(
        executor, metric_of, mesh,
        {options.goal.complexity, bounds_in_force(executor, mesh, options.goal.bounds),
         options.gradation, options.goal.elements});
  else if (options.gradation > 0)
    limit_gradation(executor, metric_of, mesh, {.factor = options.gradation});
  const auto& at_nodes = charts.restricted(executor, metric_of);
  for (const auto& hessian_of : hessians)
    found.error = std::max(
        found.error, error_of(executor, nodes.share_of, at_nodes, hessian_of, options.goal.norm));
  found.complexity = complexity(executor, mesh, metric_of);
  if (!(options.goal.elements > 0))
    found.elements = found.complexity / complexity_of_elements(Dim, 1);
  return {symmetric_field(executor, metric_of, field.name), found};
}

}  // namespace

template <int Dim>
FittedMetric<Dim> hessian_metric(const Executor& executor, const FixedMesh<Dim>& mesh,
                                 const std::vector<Metric<Dim>>& hessian_of,
                                 const HessianMetricOptions& options) {
  FittedMetric<Dim> fitted = fit(executor, mesh, hessian_of, options);
  if (options.elements > 0) {
    fitted.fit = scale_to_complexity<Dim>(
        executor, fitted.metric_of, mesh,
        {.bounds = bounds_in_force(executor, mesh, options.bounds), .elements = options.elements});
    fitted.fit.error =
        error_of(executor, mesh.share_of, fitted.metric_of, hessian_of, options.norm);
  }
  return fitted;
}

SolutionMetric solution_metric(const Executor& executor, const AnyMesh& mesh, const AnyField& field,
                               const SolutionMetricOptions& options) {
  expect_field_of(field, mesh);
  if (is_surface(mesh)) return solution_metric_in<2, 3>(executor, mesh, field, options);
  return mesh.dimension == 2 ? solution_metric_in<2>(executor, mesh, field, options)
                             : solution_metric_in<3>(executor, mesh, field, options);
}

template FittedMetric<2> hessian_metric(const Executor&, const FixedMesh<2>&,
                                        const std::vector<Metric<2>>&, const HessianMetricOptions&);
template FittedMetric<3> hessian_metric(const Executor&, const FixedMesh<3>&,
                                        const std::vector<Metric<3>>&, const HessianMetricOptions&);

}  // namespace ductile::meshadapt
