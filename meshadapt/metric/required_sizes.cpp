#include "metric/required_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "metric/metric_range.hpp"
#include "metric/required_entities.hpp"
#include "metric/vertex_neighbours.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// A metric that holds at a vertex because of what is required there.
template <int Dim>
struct Source {
  VertexId vertex;
  Metric<Dim> metric;
};

template <int Dim>
Metric<Dim> inverted(const Metric<Dim>& tensor) {
  PrincipalAxes<Dim> axes = principal_axes(tensor);
  for (double& value : axes.value) value = 1 / value;
  return compose(axes);
}

/// The metric at one end of an edge as it may be at the other at most, if sizes grow at this rate:
/// a size h along one of its axes becomes h g^(1/2) g_h^(1/2), where g = 1 + l rate with the length
/// l of the edge in the metric, and g_h = 1 + |edge|/h rate. Nothing if no size is below
/// `coarsest`.
template <int Dim>
struct Growing {
  double rate, coarsest;

  std::optional<Metric<Dim>> operator()(const Metric<Dim>& metric, const Vector<Dim>& edge) const {
    const double length = std::sqrt(std::max(0.0, squared_length(metric, edge)));
    const double in_metric = 1 + length * rate, in_space = norm(edge) * rate;
    PrincipalAxes<Dim> axes = principal_axes(metric);
    bool finer = false;
    for (double& value : axes.value) {
      value /= in_metric * (1 + in_space * std::sqrt(value));  // a squared factor
      finer = finer || value * coarsest * coarsest > 1;
    }
    if (!finer) return std::nullopt;
    return compose(axes);
  }
};

/// The same for tensors of squared sizes, the inverses of metrics: how large they must be at least.
/// Nothing if no size is above `finest`.
template <int Dim>
struct Falling {
  double rate, finest;

  std::optional<Metric<Dim>> operator()(const Metric<Dim>& squares, const Vector<Dim>& edge) const {
    const PrincipalAxes<Dim> axes = principal_axes(squares);
    double square = 0, largest = 0;
    for (std::size_t i = 0; i < Dim; ++i) {
      const double along = dot(axes.vector[i], edge);
      square += along * along / axes.value[i];
      largest = std::max(largest, axes.value[i]);
    }
    const double left = 1 - std::sqrt(square) * rate;
    if (!(left * std::sqrt(largest) > finest)) return std::nullopt;
    return left * left * squares;
  }
};

/// Spreads tensors from sources over the edges of a mesh, where they change by a law and are
/// intersected: a Jacobi iteration like that of limit_gradation, of what comes from sources only.
template <int Dim, int Space, class Law>
class Spreading {
 public:
  Spreading(const Executor& executor, const Mesh<Dim, Space>& mesh, const Law& law)
      : executor_(executor),
        mesh_(mesh),
        law_(law),
        tensor_of_(mesh.vertex_slots()),
        is_reached_(mesh.vertex_slots(), 0),
        has_changed_(mesh.vertex_slots(), 0),
        neighbours_(executor, mesh) {}

  void start(VertexId vertex, const Metric<Space>& tensor) {
    tensor_of_[vertex] = tensor;
    is_reached_[vertex] = has_changed_[vertex] = 1;
    changed_.push_back(vertex);
  }

  GradationReport run() {
    GradationReport report;
    while (!changed_.empty() && report.sweeps < GradationOptions{}.sweeps) {
      sweep();
      ++report.sweeps;
      report.raised += changed_.size();
    }
    report.converged = changed_.empty();
    return report;
  }

  /// The tensor intersected with what has come to a vertex, if anything has; itself, bit for bit,
  /// if that changes nothing.
  Metric<Space> at(VertexId v, const Metric<Space>& tensor) const {
    return is_reached_[v] ? intersect(tensor, tensor_of_[v]) : tensor;
  }

 private:
  /// Finds the new tensors from the old ones, then puts them in place.
  void sweep() {
    const auto active = neighbours_.of_all(changed_);
    const auto raised = runtime::parallel_collect<Source<Space>>(
        executor_, active.size(), [&](std::size_t i, auto&& append) {
          Metric<Space> tensor = tensor_of_[active[i]];
          if (raise_from_neighbours(tensor, active[i])) append(Source<Space>{active[i], tensor});
        });
    for (const VertexId v : changed_) has_changed_[v] = 0;
    changed_.clear();
    for (const auto& [vertex, tensor] : raised) start(vertex, tensor);
  }

  bool raise_from_neighbours(Metric<Space>& tensor, VertexId vertex) {
    bool is_reached = is_reached_[vertex] != 0, raised = false;
    for (const VertexId from : neighbours_.of(vertex)) {
      if (!has_changed_[from]) continue;
      const Vector<Space> edge = mesh_.site_of[vertex].position - mesh_.site_of[from].position;
      const auto carried = law_(tensor_of_[from], edge);
      if (!carried) continue;
      const Metric<Space> both = is_reached ? intersect(tensor, *carried) : *carried;
      constexpr double tolerance = 1e-3;  // of the product of squared sizes
      if (is_reached && !(determinant(both) > (1 + tolerance) * determinant(tensor))) continue;
      tensor = both;
      is_reached = raised = true;
    }
    return raised;
  }

  const Executor& executor_;
  const Mesh<Dim, Space>& mesh_;
  Law law_;
  std::vector<Metric<Space>> tensor_of_;   // [vertex], where it is reached
  std::vector<std::uint8_t> is_reached_;   // [vertex]
  std::vector<VertexId> changed_;          // in the last sweep
  std::vector<std::uint8_t> has_changed_;  // [vertex]
  VertexNeighbours<Mesh<Dim, Space>> neighbours_;
};

template <int Dim, int Space>
std::vector<Source<Space>> sources_in(const Executor& executor, const Mesh<Dim, Space>& mesh,
                                      const std::vector<Metric<Space>>& metric_of) {
  const auto found = runtime::parallel_collect<Source<Space>>(
      executor, mesh.vertex_slots(), [&](std::size_t i, auto&& append) {
        const auto v = static_cast<VertexId>(i);
        RequiredAround<Dim, Space> around(mesh);
        if (const auto metric = metric_of_required(mesh, around, v, metric_of[v]))
          append(Source<Space>{v, *metric});
      });
  return {found.begin(), found.end()};
}

/// The range of sizes: shortest and longest.
template <int Dim>
std::pair<double, double> sizes_in(const Executor& executor,
                                   const std::vector<Metric<Dim>>& metric_of) {
  using Range = std::pair<double, double>;
  const auto range_at = [&](std::size_t v) {
    const auto value = principal_axes(metric_of[v]).value;
    const auto [least, most] = std::minmax_element(value.begin(), value.end());
    return Range{1 / std::sqrt(*most), 1 / std::sqrt(*least)};
  };
  return runtime::parallel_reduce(
      executor, metric_of.size(), Range{largest_size, smallest_size}, range_at,
      [](const Range& a, const Range& b) {
        return Range{std::min(a.first, b.first), std::max(a.second, b.second)};
      });
}

}  // namespace

template <int Dim, int Space>
GradationReport take_required_sizes(const Executor& executor, const Mesh<Dim, Space>& mesh,
                                    double factor, std::vector<Metric<Space>>& metric_of) {
  const std::vector<Source<Space>> sources = sources_in(executor, mesh, metric_of);
  if (sources.empty()) return {.converged = true};
  const auto [finest, coarsest] = sizes_in(executor, metric_of);
  const double rate = std::log(factor);
  Spreading<Dim, Space, Growing<Space>> growing(executor, mesh, {rate, coarsest});
  Spreading<Dim, Space, Falling<Space>> falling(executor, mesh, {rate, finest});
  for (const auto& [vertex, metric] : sources) {
    growing.start(vertex, metric);
    falling.start(vertex, inverted(metric));
  }
  const GradationReport up = growing.run(), down = falling.run();
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    const Metric<Space> squares = inverted(metric_of[v]), coarse = falling.at(v, squares);
    const Metric<Space> asked = coarse == squares ? metric_of[v] : inverted(coarse);
    metric_of[v] = brought_into_range(growing.at(v, asked));
  });
  for (const auto& [vertex, metric] : sources) metric_of[vertex] = metric;
  return {std::max(up.sweeps, down.sweeps), up.raised + down.raised,
          up.converged && down.converged};
}

template GradationReport take_required_sizes(const Executor&, const Mesh<2>&, double,
                                             std::vector<Metric<2>>&);
template GradationReport take_required_sizes(const Executor&, const Mesh<2, 3>&, double,
                                             std::vector<Metric<3>>&);
template GradationReport take_required_sizes(const Executor&, const Mesh<3>&, double,
                                             std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
