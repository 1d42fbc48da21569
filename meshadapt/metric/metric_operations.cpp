#include "ductile/meshadapt/metric_operations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/mesh_gradation.hpp"
#include "metric/metric_range.hpp"
#include "metric/spectrum.hpp"
#include "metric/vertex_neighbours.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A relative excess of a squared length that may be nothing but rounding.
constexpr double rounding = 64 * epsilon;

/// What cholesky() adds to a diagonal, so that errors of its factor stay below `rounding`.
constexpr double shift = 4 * rounding;

template <int Dim>
using Matrix = std::array<std::array<double, Dim>, Dim>;  // [row][column]

/// Lower Cholesky factor of `a` with its diagonal raised by `shift`. Errors do not depend on how
/// differently the axes are scaled (Demmel, LAPACK Working Note 14, 1989). What is raised covers
/// them: seen from the factor, no tensor that is `a` but for rounding is longer than 1 by more than
/// that.
template <int Dim>
Matrix<Dim> cholesky(const Metric<Dim>& a) {
  Matrix<Dim> lower{};
  for (std::size_t j = 0; j < Dim; ++j) {
    const double diagonal = a(static_cast<int>(j), static_cast<int>(j));
    double pivot = (1 + shift) * diagonal;
    for (std::size_t k = 0; k < j; ++k) pivot -= lower[j][k] * lower[j][k];
    lower[j][j] = std::sqrt(std::max(pivot, epsilon * diagonal));
    for (std::size_t i = j + 1; i < Dim; ++i) {
      double rest = a(static_cast<int>(i), static_cast<int>(j));
      for (std::size_t k = 0; k < j; ++k) rest -= lower[i][k] * lower[j][k];
      lower[i][j] = rest / lower[j][j];
    }
  }
  return lower;
}

/// L^-1 b.
template <int Dim>
std::array<double, Dim> solve(const Matrix<Dim>& lower, std::array<double, Dim> b) {
  for (std::size_t i = 0; i < Dim; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= lower[i][k] * b[k];
    b[i] /= lower[i][i];
  }
  return b;
}

/// L^-1 B L^-T: `other` seen from where LL' is the identity.
template <int Dim>
Metric<Dim> seen_from(const Matrix<Dim>& lower, const Metric<Dim>& other) {
  Matrix<Dim> half;  // [column of B], L^-1 B
  for (std::size_t j = 0; j < Dim; ++j) {
    for (std::size_t i = 0; i < Dim; ++i)
      half[j][i] = other(static_cast<int>(i), static_cast<int>(j));
    half[j] = solve<Dim>(lower, half[j]);
  }
  Metric<Dim> seen;
  for (std::size_t row = 0; row < Dim; ++row) {
    std::array<double, Dim> across;
    for (std::size_t j = 0; j < Dim; ++j) across[j] = half[j][row];
    across = solve<Dim>(lower, across);
    for (std::size_t column = row; column < Dim; ++column)
      seen.m[column * (column + 1) / 2 + row] = across[column];
  }
  return seen;
}

/// Intersects `base` with `other`: squared lengths that are longer in `other` by more than
/// `tolerance`, relatively, are raised to those. `base` is only ever added to. True if it was
/// changed.
template <int Dim>
bool raise(Metric<Dim>& base, const Metric<Dim>& other, double tolerance) {
  const Matrix<Dim> lower = cholesky(base);
  const PrincipalAxes<Dim> ratio = principal_axes(seen_from<Dim>(lower, other));
  bool changed = false;
  for (std::size_t i = 0; i < Dim; ++i) {
    const double excess = ratio.value[i] - 1;
    if (!(excess > std::max(tolerance, rounding))) continue;
    std::array<double, Dim> u{};  // L q
    for (std::size_t row = 0; row < Dim; ++row)
      for (std::size_t k = 0; k <= row; ++k) u[row] += lower[row][k] * ratio.vector[i].x[k];
    for (std::size_t column = 0, at = 0; column < Dim; ++column)
      for (std::size_t row = 0; row <= column; ++row, ++at)
        base.m[at] += excess * u[row] * u[column];
    changed = true;
  }
  return changed;
}

/// Is no squared length in `fine` shorter than in `coarse` by more than `tolerance`? A yes is
/// certain up to rounding; a no may be one only because it is close. Cheap: Cholesky without roots.
template <int Dim>
bool surely_finer(const Metric<Dim>& fine, const Metric<Dim>& coarse, double tolerance) {
  Matrix<Dim> rest;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j)
      rest[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
          (1 + tolerance) * fine(i, j) - coarse(i, j);
  for (std::size_t j = 0; j < Dim; ++j) {
    const int at = static_cast<int>(j);
    if (!(rest[j][j] > rounding * (fine(at, at) + coarse(at, at)))) return false;
    for (std::size_t i = j + 1; i < Dim; ++i) {
      const double multiple = rest[i][j] / rest[j][j];
      for (std::size_t k = j + 1; k <= i; ++k) rest[i][k] -= multiple * rest[k][j];
    }
  }
  return true;
}

double trace(const Metric<2>& a) { return a.m[0] + a.m[2]; }
double trace(const Metric<3>& a) { return a.m[0] + a.m[2] + a.m[5]; }

// ---- What gradation needs of a mesh, of either kind ----

template <int Dim>
const Vector<Dim>& place_of(const Mesh<Dim>& mesh, VertexId vertex) {
  return mesh.site_of[vertex].position;
}
template <int Dim>
const Vector<Dim>& place_of(const FixedMesh<Dim>& mesh, VertexId vertex) {
  return mesh.position_of[vertex];
}
/// The Jacobi iteration of limit_gradation. After the first sweep only vertices with a neighbour
/// that changed in the sweep before are looked at, and only against such neighbours: metrics never
/// get coarser, so a bound that held still does.
template <int Dim, class AMesh>
class Gradation {
 public:
  Gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of, const AMesh& mesh,
            const GradationOptions& options)
      : executor_(executor),
        metric_of_(metric_of),
        mesh_(mesh),
        options_(options),
        rate_(std::log(options.factor)),
        changed_(metric_of.size()),
        has_changed_(metric_of.size(), 1),
        axes_of_(metric_of.size()),
        neighbours_(executor, mesh) {
    std::iota(changed_.begin(), changed_.end(), VertexId{0});
  }

  GradationReport run() {
    GradationReport report;
    runtime::UnsetVector<VertexId> active(changed_.begin(), changed_.end());
    while (!active.empty() && report.sweeps < options_.sweeps) {
      sweep(active);
      ++report.sweeps;
      report.raised += changed_.size();
      active = neighbours_.of_all(changed_);
    }
    report.converged = active.empty();
    if (report.raised > 0)
      runtime::parallel_for(executor_, metric_of_.size(), [&](std::size_t v) {
        metric_of_[v] = brought_into_range(metric_of_[v]);
      });
    return report;
  }

 private:
  /// For loops of a few writes per vertex.
  static constexpr runtime::LoopOptions cheap{.serial_below = 8192};

  struct Raised {
    VertexId vertex;
    Metric<Dim> metric;
  };

  /// Finds the new metrics from the old ones, then puts them in place.
  void sweep(std::span<const VertexId> active) {
    runtime::parallel_for(executor_, changed_.size(), [&](std::size_t i) {
      axes_of_[changed_[i]] = principal_axes(metric_of_[changed_[i]]);
    });
    const auto raised = runtime::parallel_collect<Raised>(
        executor_, active.size(), [&](std::size_t i, auto&& append) {
          Metric<Dim> metric = metric_of_[active[i]];
          if (raise_from_neighbours(metric, active[i])) append(Raised{active[i], metric});
        });
    runtime::parallel_for(
        executor_, changed_.size(), [&](std::size_t i) { has_changed_[changed_[i]] = 0; }, cheap);
    changed_.resize(raised.size());
    runtime::parallel_for(
        executor_, raised.size(),
        [&](std::size_t i) {
          metric_of_[raised[i].vertex] = raised[i].metric;
          has_changed_[raised[i].vertex] = 1;
          changed_[i] = raised[i].vertex;
        },
        cheap);
  }

  bool raise_from_neighbours(Metric<Dim>& metric, VertexId vertex) {
    bool raised = false;
    for (const VertexId from : neighbours_.of(vertex)) {
      if (!has_changed_[from]) continue;
      const Metric<Dim> reaching = grown(from, vertex);
      if (!surely_finer(metric, reaching, options_.tolerance))
        raised = raise(metric, reaching, options_.tolerance) || raised;
    }
    return raised;
  }

  /// The metric at `from` as it may be at `to` at most: a size h grows by g^(7/8) g_h^(1/8), where
  /// g is the growth over the edge's length in the metric and g_h that over its length in h.
  Metric<Dim> grown(VertexId from, VertexId to) const {
    const Vector<Dim> edge = place_of(mesh_, to) - place_of(mesh_, from);
    const double length = std::sqrt(std::max(0.0, squared_length(metric_of_[from], edge)));
    const double in_metric = 1 + length * rate_, in_space = norm(edge) * rate_;
    PrincipalAxes<Dim> axes = axes_of_[from];
    for (double& value : axes.value) {
      const double in_size = 1 + in_space * std::sqrt(std::max(0.0, value));
      const double growth = in_metric * std::sqrt(std::sqrt(std::sqrt(in_size / in_metric)));
      value /= growth * growth;
    }
    return compose(axes);
  }

  const Executor& executor_;
  std::vector<Metric<Dim>>& metric_of_;  // [vertex]
  const AMesh& mesh_;
  GradationOptions options_;
  double rate_;                                       // growth per unit length
  std::vector<VertexId> changed_;                     // in the last sweep, all before the first
  std::vector<std::uint8_t> has_changed_;             // [vertex]
  runtime::UnsetVector<PrincipalAxes<Dim>> axes_of_;  // [vertex], of those that changed
  VertexNeighbours<AMesh> neighbours_;
};

[[noreturn]] void refuse_gradation(double factor) {
  throw InputError("gradation: expected a factor of 1 or more, found " + number(factor));
}

void expect_gradable(std::size_t metrics, std::size_t vertices, const GradationOptions& options) {
  if (!(options.factor >= 1) || !std::isfinite(options.factor)) refuse_gradation(options.factor);
  if (!(options.tolerance >= 0) || options.sweeps < 0)
    throw InputError("gradation: expected a tolerance and sweeps of 0 or more, found " +
                     number(options.tolerance) + " and " + std::to_string(options.sweeps));
  if (metrics != vertices)
    throw InputError("metric_of: expected a metric for each of the " + std::to_string(vertices) +
                     " vertices, found " + std::to_string(metrics));
}

}  // namespace

void expect_bounds(const SizeBounds& bounds) {
  const auto [smallest, largest, anisotropy] = bounds;
  const auto is_size = [](double x) {
    return x == 0 || (x >= meshadapt::smallest_size && x <= meshadapt::largest_size);
  };
  if (!is_size(smallest) || !is_size(largest) || (largest > 0 && smallest > largest))
    throw InputError(
        "bounds on sizes: expected 0 (none) or from 1e-75 to 1e75, and the smallest not above the "
        "largest, found " +
        number(smallest) + " and " + number(largest));
  if (!(anisotropy == 0 || (anisotropy >= 1 && std::isfinite(anisotropy))))
    throw InputError("bound on the anisotropy: expected 0 (none) or 1 or more, found " +
                     number(anisotropy));
}

void expect_gradation(double factor) {
  if (!(factor <= 0 || (factor >= 1 && std::isfinite(factor)))) refuse_gradation(factor);
}

template <int Dim>
Metric<Dim> intersect(const Metric<Dim>& a, const Metric<Dim>& b) {
  // One that is finer everywhere has the larger trace, so it is the base, and nothing is added.
  const bool a_first = std::pair(trace(a), a.m) > std::pair(trace(b), b.m);
  Metric<Dim> result = a_first ? a : b;
  raise(result, a_first ? b : a, rounding);
  return result;
}

template <int Dim>
void intersect(const runtime::Executor& executor, std::vector<Metric<Dim>>& metric_of,
               const std::vector<Metric<Dim>>& other_of) {
  if (metric_of.size() != other_of.size())
    throw InputError("other_of: expected as many metrics as the " +
                     std::to_string(metric_of.size()) + " in metric_of, found " +
                     std::to_string(other_of.size()));
  expect_metrics(executor, metric_of, "metric_of");
  expect_metrics(executor, other_of, "other_of");
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    metric_of[v] = brought_into_range(intersect(metric_of[v], other_of[v]));
  });
}

template <int Dim>
void bound_sizes(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                 const SizeBounds& bounds) {
  expect_bounds(bounds);
  expect_metrics(executor, metric_of, "metric_of", bounds);
  if (!has_bounds(bounds)) return;
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    if (!in_range(metric_of[v])) metric_of[v] = within_bounds(metric_of[v], bounds);
    PrincipalAxes<Dim> axes = principal_axes(metric_of[v]);
    const auto within = bounded(axes.value, bounds);
    if (within == axes.value) return;
    axes.value = within;
    metric_of[v] = brought_into_range(compose(axes));
  });
}

template <int Dim>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                                const Mesh<Dim>& mesh, const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_slots(), options);
  return Gradation<Dim, Mesh<Dim>>(executor, metric_of, mesh, options).run();
}

template <int Dim>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                                const FixedMesh<Dim>& mesh, const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_count(), options);
  expect_metrics(executor, metric_of, "metric_of");
  return Gradation<Dim, FixedMesh<Dim>>(executor, metric_of, mesh, options).run();
}

template Metric<2> intersect(const Metric<2>&, const Metric<2>&);
template Metric<3> intersect(const Metric<3>&, const Metric<3>&);
template void intersect(const runtime::Executor&, std::vector<Metric<2>>&,
                        const std::vector<Metric<2>>&);
template void intersect(const runtime::Executor&, std::vector<Metric<3>>&,
                        const std::vector<Metric<3>>&);
template void bound_sizes(const Executor&, std::vector<Metric<2>>&, const SizeBounds&);
template void bound_sizes(const Executor&, std::vector<Metric<3>>&, const SizeBounds&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&,
                                         const FixedMesh<2>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&,
                                         const FixedMesh<3>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&, const Mesh<2>&,
                                         const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&, const Mesh<3>&,
                                         const GradationOptions&);

}  // namespace ductile::meshadapt
