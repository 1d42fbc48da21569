#include "metric/required_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "metric/metric_range.hpp"
#include "metric/required_entities.hpp"

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

template <int Dim>
double largest_value(const Metric<Dim>& tensor) {
  const auto value = principal_axes(tensor).value;
  return *std::max_element(value.begin(), value.end());
}

/// How coarse sizes must be at least, from the sources on: a Jacobi iteration like that of
/// limit_gradation, on the tensors of squared sizes, the inverses of the metrics. What is coarser
/// than something in either of two metrics is the intersection of their inverses.
template <int Dim>
class Falling {
 public:
  /// Sizes below `finest` are not looked at.
  Falling(const Executor& executor, const Mesh<Dim>& mesh, double factor, double finest)
      : executor_(executor),
        mesh_(mesh),
        rate_(std::log(factor)),
        finest_(finest),
        squares_of_(mesh.vertex_slots()),
        is_reached_(mesh.vertex_slots(), 0),
        has_changed_(mesh.vertex_slots(), 0),
        neighbours_(executor),
        wake_(executor, {.unique = true}) {}

  GradationReport run(const std::vector<Source<Dim>>& sources) {
    for (const auto& [vertex, metric] : sources) {
      squares_of_[vertex] = inverted(metric);
      is_reached_[vertex] = 1;
      has_changed_[vertex] = 1;
      changed_.push_back(vertex);
    }
    GradationReport report;
    while (!changed_.empty() && report.sweeps < GradationOptions{}.sweeps) {
      sweep();
      ++report.sweeps;
      report.raised += changed_.size();
    }
    report.converged = changed_.empty();
    return report;
  }

  /// The metric, or one that is coarser where it must be.
  Metric<Dim> coarsened(VertexId v, const Metric<Dim>& metric) const {
    if (!is_reached_[v]) return metric;
    const Metric<Dim> squares = inverted(metric);
    const Metric<Dim> coarse = intersect(squares, squares_of_[v]);
    return coarse == squares ? metric : brought_into_range(inverted(coarse));
  }

 private:
  /// Finds the new tensors from the old ones, then puts them in place.
  void sweep() {
    const auto active = woken();
    const auto raised = runtime::parallel_collect<Source<Dim>>(
        executor_, active.size(), [&](std::size_t i, auto&& append) {
          Metric<Dim> squares = squares_of_[active[i]];
          if (raise_from_neighbours(squares, active[i])) append(Source<Dim>{active[i], squares});
        });
    for (const VertexId v : changed_) has_changed_[v] = 0;
    changed_.clear();
    for (const auto& [vertex, squares] : raised) {
      squares_of_[vertex] = squares;
      is_reached_[vertex] = 1;
      has_changed_[vertex] = 1;
      changed_.push_back(vertex);
    }
  }

  bool raise_from_neighbours(Metric<Dim>& squares, VertexId vertex) {
    bool is_reached = is_reached_[vertex] != 0, raised = false;
    for (const VertexId from : neighbours(vertex)) {
      if (!has_changed_[from]) continue;
      const Metric<Dim> least = fallen(from, vertex);
      if (!(least.m[0] > 0)) continue;
      const Metric<Dim> both = is_reached ? intersect(squares, least) : least;
      constexpr double tolerance = 1e-3;  // of the product of squared sizes
      if (is_reached && !(determinant(both) > (1 + tolerance) * determinant(squares))) continue;
      squares = both;
      is_reached = raised = true;
    }
    return raised;
  }

  /// The squared sizes at `from` as they must be at `to` at least; 0 if they may be anything.
  Metric<Dim> fallen(VertexId from, VertexId to) const {
    const Vector<Dim> edge = mesh_.site_of[to].position - mesh_.site_of[from].position;
    const PrincipalAxes<Dim> axes = principal_axes(squares_of_[from]);
    double square = 0, largest = 0;
    for (std::size_t i = 0; i < Dim; ++i) {
      const double along = dot(axes.vector[i], edge);
      square += along * along / axes.value[i];
      largest = std::max(largest, axes.value[i]);
    }
    const double left = 1 - std::sqrt(square) * rate_;
    if (!(left * std::sqrt(largest) > finest_)) return {};
    return left * left * squares_of_[from];
  }

  /// In the order of their numbers; valid until the thread asks again.
  std::span<const VertexId> neighbours(VertexId vertex) {
    std::vector<VertexId>& found = neighbours_.mine();
    found.clear();
    for (const ElementId element : mesh_.elements_of.of(vertex))
      for (const VertexId corner : mesh_.corners_of[element])
        if (corner != vertex) found.push_back(corner);
    std::sort(found.begin(), found.end());
    return {found.begin(), std::unique(found.begin(), found.end())};
  }

  runtime::UnsetVector<VertexId> woken() {
    runtime::parallel_for(executor_, changed_.size(),
                          [&](std::size_t i) {
                            for (const VertexId neighbour : neighbours(changed_[i]))
                              wake_.append(neighbour);
                          },
                          {.serial_below = 256});
    wake_.collect();
    return wake_.take();
  }

  const Executor& executor_;
  const Mesh<Dim>& mesh_;
  double rate_, finest_;
  std::vector<Metric<Dim>> squares_of_;    // [vertex], where it is reached
  std::vector<std::uint8_t> is_reached_;   // [vertex]
  std::vector<VertexId> changed_;          // in the last sweep
  std::vector<std::uint8_t> has_changed_;  // [vertex]
  runtime::PerThread<std::vector<VertexId>> neighbours_;
  runtime::Worklist<VertexId> wake_;
};

template <int Dim>
std::vector<Source<Dim>> sources_in(const Executor& executor, const Mesh<Dim>& mesh,
                                    const std::vector<Metric<Dim>>& metric_of) {
  runtime::PerThread<std::optional<RequiredAround<Dim>>> around(executor);
  const auto found = runtime::parallel_collect<Source<Dim>>(
      executor, mesh.vertex_slots(), [&](std::size_t i, auto&& append) {
        const auto v = static_cast<VertexId>(i);
        std::optional<RequiredAround<Dim>>& mine = around.mine();
        if (!mine) mine.emplace(mesh);
        if (const auto metric = metric_of_required(mesh, *mine, v, metric_of[v]))
          append(Source<Dim>{v, *metric});
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

template <int Dim>
GradationReport take_required_sizes(const Executor& executor, const Mesh<Dim>& mesh, double factor,
                                    std::vector<Metric<Dim>>& metric_of) {
  const std::vector<Source<Dim>> sources = sources_in(executor, mesh, metric_of);
  if (sources.empty()) return {.converged = true};
  const auto [finest, coarsest] = sizes_in(executor, metric_of);
  const double no_limit = std::min(2 * coarsest, largest_size);
  std::vector<Metric<Dim>> growing(metric_of.size(), isotropic<Dim>(no_limit));
  for (const auto& [vertex, metric] : sources) growing[vertex] = metric;
  const GradationReport up =
      limit_gradation(executor, growing, mesh, GradationOptions{.factor = factor});
  Falling<Dim> falling(executor, mesh, factor, finest);
  const GradationReport down = falling.run(sources);
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t i) {
    const auto v = static_cast<VertexId>(i);
    metric_of[v] = brought_into_range(intersect(falling.coarsened(v, metric_of[v]), growing[v]));
  });
  for (const auto& [vertex, metric] : sources) metric_of[vertex] = metric;
  return {std::max(up.sweeps, down.sweeps), up.raised + down.raised,
          up.converged && down.converged};
}

template GradationReport take_required_sizes(const Executor&, const Mesh<2>&, double,
                                             std::vector<Metric<2>>&);
template GradationReport take_required_sizes(const Executor&, const Mesh<3>&, double,
                                             std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
