#include "ductile/meshadapt/metric_operations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/mesh_gradation.hpp"
#include "metric/metric_range.hpp"
#include "metric/raise.hpp"
#include "metric/spectrum.hpp"
#include "metric/vertex_neighbours.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

// ---- What gradation needs of a mesh, of either kind ----

template <int Dim, int Space>
const Vector<Space>& place_of(const Mesh<Dim, Space>& mesh, VertexId vertex) {
  return mesh.site_of[vertex].position;
}
template <int Dim, int Space>
const Vector<Space>& place_of(const FixedMesh<Dim, Space>& mesh, VertexId vertex) {
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
        finest_of_(metric_of.size()),
        neighbours_(executor, mesh) {
    std::iota(changed_.begin(), changed_.end(), VertexId{0});
    neighbours_.keep(metric_of.size());
  }

  GradationReport run() {
    GradationReport report;
    const std::vector<VertexId> all = changed_;
    while (!changed_.empty() && report.sweeps < options_.sweeps) {
      // If many have changed, looking at all vertices takes less time than sorting those to wake.
      if (changed_.size() > all.size() / 32)
        sweep(all);
      else
        sweep(neighbours_.of_all(changed_));
      ++report.sweeps;
      report.raised += changed_.size();
    }
    report.converged = changed_.empty();
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
    double finest;
  };

  /// Finds the new metrics from the old ones, then puts them in place.
  void sweep(std::span<const VertexId> active) {
    runtime::parallel_for(executor_, changed_.size(), [&](std::size_t i) {
      const VertexId v = changed_[i];
      const auto& value = (axes_of_[v] = principal_axes(metric_of_[v])).value;
      if (finest_of_[v] == 0) finest_of_[v] = finer * *std::max_element(value.begin(), value.end());
    });
    const auto raised = runtime::parallel_collect<Raised>(
        executor_, active.size(), [&](std::size_t i, auto&& append) {
          Raised at{active[i], metric_of_[active[i]], finest_of_[active[i]]};
          if (raise_from_neighbours(at)) append(at);
        });
    runtime::parallel_for(
        executor_, changed_.size(), [&](std::size_t i) { has_changed_[changed_[i]] = 0; }, cheap);
    changed_.resize(raised.size());
    runtime::parallel_for(
        executor_, raised.size(),
        [&](std::size_t i) {
          metric_of_[raised[i].vertex] = raised[i].metric;
          finest_of_[raised[i].vertex] = raised[i].finest;
          has_changed_[raised[i].vertex] = 1;
          changed_[i] = raised[i].vertex;
        },
        cheap);
  }

  bool raise_from_neighbours(Raised& at) {
    bool raised = false;
    for (const VertexId from : neighbours_.of(at.vertex)) {
      if (!has_changed_[from]) continue;
      const Vector<Dim> edge = place_of(mesh_, at.vertex) - place_of(mesh_, from);
      const double growth =
          1 + rate_ * std::sqrt(std::max(0.0, squared_length(metric_of_[from], edge)));
      // No size grows by less than g^(7/8), which is seen without the axes.
      const double least = growth * growth / std::sqrt(std::sqrt(growth));
      if (raising::surely_finer(least * at.metric, metric_of_[from], options_.tolerance)) continue;
      const auto [vertex, reaching, finest] = grown(from, norm(edge) * rate_, growth);
      if (raising::surely_finer(at.metric, reaching, options_.tolerance)) continue;
      at.finest = std::max(at.finest, finest);
      raised = raising::raise_up_to(at.finest, at.metric, reaching, options_.tolerance) || raised;
    }
    return raised;
  }

  /// The metric at `from` as it may be at most where an edge leads: a size h grows by
  /// g^(7/8) g_h^(1/8), where g is the growth over the edge's length in the metric and g_h that
  /// over its length in h.
  Raised grown(VertexId from, double in_space, double in_metric) const {
    const auto grow = [&](double value) {
      const double in_size = 1 + in_space * std::sqrt(std::max(0.0, value));
      const double growth = in_metric * std::sqrt(std::sqrt(std::sqrt(in_size / in_metric)));
      return value / (growth * growth);
    };
    PrincipalAxes<Dim> axes = axes_of_[from];
    for (double& value : axes.value) value = grow(value);
    return {from, compose(axes), grow(finest_of_[from])};
  }

  /// By how much eigenvalues may exceed the largest that spreads to a vertex: at 1 the direction of
  /// the shortest size could not turn.
  static constexpr double finer = 1.2;

  const Executor& executor_;
  std::vector<Metric<Dim>>& metric_of_;  // [vertex]
  const AMesh& mesh_;
  GradationOptions options_;
  double rate_;                                       // growth per unit length
  std::vector<VertexId> changed_;                     // in the last sweep, all before the first
  std::vector<std::uint8_t> has_changed_;             // [vertex]
  runtime::UnsetVector<PrincipalAxes<Dim>> axes_of_;  // [vertex], of those that changed
  std::vector<double> finest_of_;                     // [vertex], no eigenvalue is larger
  VertexNeighbours<AMesh> neighbours_;
};

[[noreturn]] void refuse_gradation(double factor, const char* option) {
  throw InputError(std::string(option) + ": expected a factor of 1 or more, found " +
                   number(factor));
}

void expect_gradable(std::size_t metrics, std::size_t vertices, const GradationOptions& options) {
  if (!(options.factor >= 1) || !std::isfinite(options.factor))
    refuse_gradation(options.factor, "gradation");
  if (!(options.tolerance >= 0) || options.sweeps < 0)
    throw InputError("gradation: expected a tolerance and sweeps of 0 or more, found " +
                     number(options.tolerance) + " and " + std::to_string(options.sweeps));
  expect_at_each_vertex("metric_of: expected a metric", vertices, metrics);
}

}  // namespace

void expect_gradation(double factor, const char* option) {
  if (!(factor <= 0 || (factor >= 1 && std::isfinite(factor)))) refuse_gradation(factor, option);
}

template <int Dim, int Space>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Space>>& metric_of,
                                const Mesh<Dim, Space>& mesh, const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_slots(), options);
  return Gradation<Space, Mesh<Dim, Space>>(executor, metric_of, mesh, options).run();
}

template <int Dim, int Space>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Space>>& metric_of,
                                const FixedMesh<Dim, Space>& mesh,
                                const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_count(), options);
  expect_metrics(executor, metric_of, "metric_of");
  return Gradation<Space, FixedMesh<Dim, Space>>(executor, metric_of, mesh, options).run();
}

template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&,
                                         const FixedMesh<2>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&,
                                         const FixedMesh<2, 3>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&,
                                         const FixedMesh<3>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&, const Mesh<2>&,
                                         const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&,
                                         const Mesh<2, 3>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&, const Mesh<3>&,
                                         const GradationOptions&);

}  // namespace ductile::meshadapt
