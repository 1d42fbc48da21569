#include "ductile/meshadapt/metric_operations.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/gradation.hpp"
#include "metric/mesh_gradation.hpp"
#include "metric/metric_range.hpp"
#include "metric/raise.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

template <int Dim>
const Vector<Dim>& place_of(const Mesh<Dim>& mesh, VertexId vertex) {
  return mesh.site_of[vertex].position;
}
template <int Dim>
const Vector<Dim>& place_of(const FixedMesh<Dim>& mesh, VertexId vertex) {
  return mesh.position_of[vertex];
}

template <int Dim>
double trace(const Metric<Dim>& metric) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i) sum += metric(i, i);
  return sum;
}

/// An upper bound on eigenvalues at a vertex, relative to the largest that spreads to it: with 1,
/// the direction of the shortest size could not turn.
template <int Dim>
double bound_from(const PrincipalAxes<Dim>& axes) {
  constexpr double finer = 1.2;
  return finer * *std::max_element(axes.value.begin(), axes.value.end());
}

/// For loops of a few writes per vertex.
constexpr runtime::LoopOptions cheap{.serial_below = 8192};

}  // namespace

template <int Dim, class AMesh>
Gradation<Dim, AMesh>::Gradation(const Executor& executor, const AMesh& mesh, std::size_t vertices)
    : executor_(executor),
      mesh_(mesh),
      state_of_(vertices),
      fineness_of_(vertices),
      axes_of_(vertices),
      finest_of_(vertices),
      neighbours_(executor, mesh),
      reached_(executor) {
  neighbours_.keep(vertices);
}

template <int Dim, class AMesh>
GradationReport Gradation<Dim, AMesh>::limit(Metrics& metric_of, const GradationOptions& options) {
  rate_ = std::log(options.factor);
  tolerance_ = options.tolerance;
  waiting_.resize(metric_of.size());
  runtime::parallel_for(executor_, metric_of.size(), [&](std::size_t v) {
    waiting_[v] = static_cast<VertexId>(v);
    state_of_[v] = State::waiting;
    fineness_of_[v] = trace(metric_of[v]);
    finest_of_[v] = 0;
  });
  GradationReport report;
  for (; !waiting_.empty() && report.sweeps < options.sweeps; ++report.sweeps) {
    take_sources();
    report.raised += spread(metric_of);
  }
  report.converged = waiting_.empty();
  if (report.raised > 0)
    runtime::parallel_for(executor_, metric_of.size(),
                          [&](std::size_t v) { metric_of[v] = brought_into_range(metric_of[v]); });
  return report;
}

template <int Dim, class AMesh>
void Gradation<Dim, AMesh>::take_sources() {
  constexpr double close = 2;  // as a factor of squared sizes
  const double finest = runtime::parallel_reduce(
      executor_, waiting_.size(), 0.0, [&](std::size_t i) { return fineness_of_[waiting_[i]]; },
      [](double a, double b) { return std::max(a, b); });
  const auto those_waiting = [&](auto&& wanted) {
    return runtime::parallel_collect<VertexId>(
        executor_, waiting_.size(),
        [&](std::size_t i, auto&& append) {
          if (wanted(waiting_[i])) append(waiting_[i]);
        },
        cheap.serial_below);
  };
  const auto is_source = [&](VertexId v) { return fineness_of_[v] * close >= finest; };
  sources_ = those_waiting(is_source);
  waiting_ = those_waiting(std::not_fn(is_source));
  runtime::parallel_for(
      executor_, sources_.size(), [&](std::size_t i) { state_of_[sources_[i]] = State::source; },
      cheap);
}

/// Finds the new metrics from the old ones, then puts them in place. Returns how many there are.
template <int Dim, class AMesh>
std::size_t Gradation<Dim, AMesh>::spread(Metrics& metric_of) {
  find_reached(metric_of);
  const auto raised = runtime::parallel_collect<Raised>(
      executor_, reached_.size(),
      [&](std::size_t i, auto&& append) {
        const VertexId v = reached_.items()[i];
        Raised at{v, metric_of[v], finest_of_[v]};
        if (at.finest == 0) at.finest = bound_from(principal_axes(metric_of[v]));
        if (raise_from_sources(metric_of, at)) append(at);
      },
      256);
  runtime::parallel_for(
      executor_, sources_.size(), [&](std::size_t i) { state_of_[sources_[i]] = State::settled; },
      cheap);
  for (const Raised& at : raised) {
    metric_of[at.vertex] = at.metric;
    finest_of_[at.vertex] = at.finest;
    fineness_of_[at.vertex] = trace(at.metric);
    if (state_of_[at.vertex] == State::settled) waiting_.push_back(at.vertex);
    state_of_[at.vertex] = State::waiting;
  }
  return raised.size();
}

/// The vertices that a source may raise, and the axes of these sources.
template <int Dim, class AMesh>
void Gradation<Dim, AMesh>::find_reached(const Metrics& metric_of) {
  reached_.clear();
  const auto from_source = [&](std::size_t i, auto& reached) {
    const VertexId from = sources_[i];
    for (const VertexId to : neighbours_.of(from)) {
      if (growth_beyond(metric_of, from, to, metric_of[to]) == 0) continue;
      if (state_of_[from] == State::source) {
        axes_of_[from] = principal_axes(metric_of[from]);
        if (finest_of_[from] == 0) finest_of_[from] = bound_from(axes_of_[from]);
        state_of_[from] = State::spreading;
      }
      reached.append(to);
    }
  };
  runtime::parallel_for(executor_, sources_.size(), runtime::with(reached_), from_source,
                        {.serial_below = 256});
  reached_.collect_unique();
}

template <int Dim, class AMesh>
bool Gradation<Dim, AMesh>::raise_from_sources(const Metrics& metric_of, Raised& at) {
  bool raised = false;
  for (const VertexId from : neighbours_.of(at.vertex)) {
    if (state_of_[from] != State::spreading) continue;
    const double growth = growth_beyond(metric_of, from, at.vertex, at.metric);
    if (growth == 0) continue;
    const Raised reaching = grown(from, at.vertex, growth);
    if (raising::surely_finer(at.metric, reaching.metric, tolerance_)) continue;
    at.finest = std::max(at.finest, reaching.finest);
    raised = raising::raise_up_to(at.finest, at.metric, reaching.metric, tolerance_) || raised;
  }
  return raised;
}

/// Growth of sizes along an edge in the metric at its start; 0 if the metric at its end is surely
/// fine enough. No size grows by less than g^(7/8), so that is seen without the axes.
template <int Dim, class AMesh>
double Gradation<Dim, AMesh>::growth_beyond(const Metrics& metric_of, VertexId from, VertexId to,
                                            const Metric<Dim>& there) const {
  const Vector<Dim> edge = place_of(mesh_, to) - place_of(mesh_, from);
  const double growth = 1 + rate_ * std::sqrt(std::max(0.0, squared_length(metric_of[from], edge)));
  const double least = growth * growth / std::sqrt(std::sqrt(growth));
  return raising::surely_finer(least * there, metric_of[from], tolerance_) ? 0 : growth;
}

/// The coarsest metric at the end of an edge that the one at its start allows: a size h grows by
/// g^(7/8) g_h^(1/8), where g is the growth over the edge's length in the metric and g_h that over
/// its length in h.
template <int Dim, class AMesh>
auto Gradation<Dim, AMesh>::grown(VertexId from, VertexId to, double growth) const -> Raised {
  const double in_space = rate_ * norm(place_of(mesh_, to) - place_of(mesh_, from));
  const auto grow = [&](double value) {
    const double in_size = 1 + in_space * std::sqrt(std::max(0.0, value));
    const double mixed = growth * std::sqrt(std::sqrt(std::sqrt(in_size / growth)));
    return value / (mixed * mixed);
  };
  PrincipalAxes<Dim> axes = axes_of_[from];
  for (double& value : axes.value) value = grow(value);
  return {to, compose(axes), grow(finest_of_[from])};
}

namespace {

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
  if (metrics != vertices)
    throw InputError("metric_of: expected a metric for each of the " + std::to_string(vertices) +
                     " vertices, found " + std::to_string(metrics));
}

}  // namespace

void expect_gradation(double factor, const char* option) {
  if (!(factor <= 0 || (factor >= 1 && std::isfinite(factor)))) refuse_gradation(factor, option);
}

template <int Dim>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                                const Mesh<Dim>& mesh, const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_slots(), options);
  return Gradation<Dim, Mesh<Dim>>(executor, mesh, metric_of.size()).limit(metric_of, options);
}

template <int Dim>
GradationReport limit_gradation(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                                const FixedMesh<Dim>& mesh, const GradationOptions& options) {
  expect_gradable(metric_of.size(), mesh.vertex_count(), options);
  expect_metrics(executor, metric_of, "metric_of");
  return Gradation<Dim, FixedMesh<Dim>>(executor, mesh, metric_of.size()).limit(metric_of, options);
}

template class Gradation<2, FixedMesh<2>>;
template class Gradation<3, FixedMesh<3>>;
template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&,
                                         const FixedMesh<2>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&,
                                         const FixedMesh<3>&, const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<2>>&, const Mesh<2>&,
                                         const GradationOptions&);
template GradationReport limit_gradation(const Executor&, std::vector<Metric<3>>&, const Mesh<3>&,
                                         const GradationOptions&);

}  // namespace ductile::meshadapt
