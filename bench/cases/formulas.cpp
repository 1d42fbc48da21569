#include "cases/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cases/psi.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::bench {

using meshadapt::Metric;
using meshadapt::Vector;

namespace {

/// The mean of value(x, y) over the unit square, at the middles of n x n cells.
template <class Value>
double mean_over_square(const runtime::Executor& executor, std::size_t n, Value&& value) {
  const auto column = [&](std::size_t i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j)
      sum += value((static_cast<double>(i) + 0.5) / static_cast<double>(n),
                   (static_cast<double>(j) + 0.5) / static_cast<double>(n));
    return sum;
  };
  return runtime::parallel_reduce(executor, n, 0.0, column, std::plus<>{}) /
         static_cast<double>(n * n);
}

// ---- psi ----

constexpr double least_curvature = 0.01, smallest_size = 1e-5, largest_size = 0.3;

/// The eigenvalues, in no order, and eigenvectors of det(|H|)^(-1/(4 + Dim)) |H|.
template <int Dim>
meshadapt::PrincipalAxes<Dim> unscaled_psi_metric(double x, double y) {
  const PsiHessian hessian = psi_hessian(x, y, 0);
  const auto plane = meshadapt::principal_axes(Metric<2>{{hessian.xx, hessian.xy, hessian.yy}});
  meshadapt::PrincipalAxes<Dim> axes{};
  axes.vector[Dim - 1][Dim - 1] = 1;
  for (std::size_t i = 0; i < 2; ++i) {
    axes.value[i] = plane.value[i];
    for (int k = 0; k < 2; ++k) axes.vector[i][k] = plane.vector[i][k];
  }
  double determinant = 1;
  for (double& value : axes.value) {
    value = std::max(std::abs(value), least_curvature);
    determinant *= value;
  }
  const double equaliser = std::pow(determinant, -1.0 / (4 + Dim));
  for (double& value : axes.value) value *= equaliser;
  return axes;
}

template <int Dim>
double density(const meshadapt::PrincipalAxes<Dim>& axes, double factor) {
  double determinant = 1;
  for (const double value : axes.value)
    determinant *= std::clamp(factor * value, 1 / (largest_size * largest_size),
                              1 / (smallest_size * smallest_size));
  return std::sqrt(determinant);
}

/// The factor with which the bounded metric has this complexity. Bounds apply in few places, so
/// scaling without regard to them converges in a few steps.
template <int Dim>
double psi_factor(const runtime::Executor& executor, double complexity) {
  double factor = 1;
  for (int again = 0; again < 40; ++again) {
    const double now = mean_over_square(executor, 500, [&](double x, double y) {
      return density<Dim>(unscaled_psi_metric<Dim>(x, y), factor);
    });
    factor *= std::pow(complexity / now, 2.0 / Dim);
    if (std::abs(now / complexity - 1) < 1e-9) break;
  }
  return factor;
}

/// The metric with the size `across` along the direction and `along` at right angles to it.
template <int Dim>
Metric<Dim> stretched(const Vector<Dim>& direction, double across, double along) {
  Metric<Dim> metric = meshadapt::isotropic<Dim>(along);
  const double more = 1 / (across * across) - 1 / (along * along);
  for (int i = 0, k = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j, ++k)
      metric.m[static_cast<std::size_t>(k)] += more * direction[i] * direction[j];
  return metric;
}

// ---- Layers ----

/// A size that grows linearly from 0.001 to 0.1 over a distance of 1/2.
double layer_size(double distance) { return 0.001 + 0.198 * distance; }

/// A place relative to the curved layer: its height above the layer, the slopes of the layer along
/// x and y, and its distance along the layer's normal.
struct LayerPlace {
  double below = 0, slope_x = 0, slope_y = 0;
  double steepness() const { return std::sqrt(1 + slope_x * slope_x + slope_y * slope_y); }
  double distance() const { return std::abs(below) / steepness(); }
};

LayerPlace layer_place(const Vector<3>& place) {
  constexpr double pi = std::numbers::pi, height = 0.05;
  const double x = pi * place[0], y = pi * place[1];
  return {place[2] - 0.5 - height * std::cos(x) * std::cos(y),
          height * pi * std::sin(x) * std::cos(y), height * pi * std::cos(x) * std::sin(y)};
}

/// Ratio of the size across the layer to that along it.
double layer_ratio(const LayerPlace& place) { return std::min(1.0, 0.01 + 2 * place.distance()); }

}  // namespace

template <int Dim>
Formula<Dim> psi_metric(const runtime::Executor& executor, double complexity) {
  return [factor = psi_factor<Dim>(executor, complexity)](const Vector<Dim>& place) {
    auto axes = unscaled_psi_metric<Dim>(place[0], place[1]);
    for (double& value : axes.value)
      value = std::clamp(factor * value, 1 / (largest_size * largest_size),
                         1 / (smallest_size * smallest_size));
    return meshadapt::compose(axes);
  };
}

template <int Dim>
Formula<Dim> uniform_metric(double size) {
  return [metric = meshadapt::isotropic<Dim>(size)](const Vector<Dim>&) { return metric; };
}

Metric<2> circle_metric(const Vector<2>& place) {
  Vector<2> out = place - Vector<2>{{0.5, 0.5}};
  const double radius = norm(out);
  out *= radius > 0 ? 1 / radius : 0;
  const double size = std::min(0.1, layer_size(2 * std::abs(radius - 0.25)));
  return stretched<2>(out, size, 0.1);
}

Metric<2> turning_metric(const Vector<2>& place) {
  const double turn = 1.5 * place[0] + 0.5 * place[1];
  return stretched<2>({{std::cos(turn), std::sin(turn)}}, 0.004, 0.1);
}

Metric<3> turning_metric(const Vector<3>& place) {
  const double turn = 1.2 * place[0] + 0.6 * place[1], rise = 0.8 * place[0] + 0.4 * place[2];
  return stretched<3>(
      {{std::cos(rise) * std::cos(turn), std::cos(rise) * std::sin(turn), std::sin(rise)}}, 0.01,
      0.25);
}

Metric<2> boundary_metric(const Vector<2>& place) {
  const double size = std::min(0.01, 1e-5 + 0.2 * place[1]);
  return {{1e4, 0, 1 / (size * size)}};
}

Metric<3> cube_linear_metric(const Vector<3>& place) {
  const double size = layer_size(std::abs(place[2] - 0.5));
  return {{100, 0, 100, 0, 0, 1 / (size * size)}};
}

/// size^-2 (identity + (ratio^-2 - 1) normal normal'), whose density is size^-3 / ratio.
Formula<3> curved_layer_metric(const runtime::Executor& executor, double complexity) {
  constexpr int steps = 2000;  // along z, where the ratio changes fast
  const double sum_of_inverses = mean_over_square(executor, 40, [](double x, double y) {
    double sum = 0;
    for (int k = 0; k < steps; ++k)
      sum += 1 / layer_ratio(layer_place({{x, y, (k + 0.5) / steps}})) / steps;
    return sum;
  });
  const double scale = std::pow(complexity / sum_of_inverses, 2.0 / 3);
  return [scale](const Vector<3>& at) {
    const LayerPlace place = layer_place(at);
    const double ratio = layer_ratio(place), more = scale * (1 / (ratio * ratio) - 1);
    const double z = 1 / place.steepness(), x = place.slope_x * z, y = place.slope_y * z;
    return Metric<3>{{scale + more * x * x, more * x * y, scale + more * y * y, more * x * z,
                      more * y * z, scale + more * z * z}};
  };
}

template <int Dim>
Formula<Dim> scaled(Formula<Dim> formula, double factor) {
  return [formula = std::move(formula), factor](const Vector<Dim>& place) {
    return factor * formula(place);
  };
}

template <int Dim>
meshadapt::AnyField sampled_metric(const runtime::Executor& executor,
                                   const meshadapt::AnyMesh& mesh, const Formula<Dim>& formula) {
  std::vector<Metric<Dim>> metric_of(mesh.vertex_count());
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    Vector<Dim> place;
    std::copy_n(&mesh.coordinates[v * Dim], Dim, place.x.begin());
    metric_of[v] = formula(place);
  });
  return meshadapt::symmetric_field<Dim>(executor, metric_of, mesh.name + ", metric");
}

template Formula<2> psi_metric<2>(const runtime::Executor&, double);
template Formula<3> psi_metric<3>(const runtime::Executor&, double);
template Formula<2> uniform_metric<2>(double);
template Formula<3> uniform_metric<3>(double);
template Formula<2> scaled<2>(Formula<2>, double);
template Formula<3> scaled<3>(Formula<3>, double);
template meshadapt::AnyField sampled_metric<2>(const runtime::Executor&, const meshadapt::AnyMesh&,
                                               const Formula<2>&);
template meshadapt::AnyField sampled_metric<3>(const runtime::Executor&, const meshadapt::AnyMesh&,
                                               const Formula<3>&);

}  // namespace ductile::bench
