/// @file
/// MetricPath: continuation through metrics between a mesh's implied metric and a distant target.
/// In a metric in which nearly all elements are slivers no kernel can tell which change improves
/// them: splits would make slivers of slivers, and are refused or never end. Elements stretched
/// three times as much as before are no trouble.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/determinant.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/mesh.hpp"
#include "metric/interpolation.hpp"
#include "metric/metric_of_element.hpp"
#include "operators/background.hpp"

namespace ductile::meshadapt {

/// Changes the metric of a background. Thread safety: one caller; runs on the executor.
template <int Dim, int Space = Dim>
class MetricPath {
 public:
  /// Starts at the metric of the elements of the mesh, which the background is a copy of. The
  /// number of steps follows from a mean over the vertices, weighted equally or by the number of
  /// elements that the target asks for around them.
  MetricPath(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
             Background<Dim, Space>& background, bool by_demand)
      : executor_(executor),
        background_(background),
        from_(mesh.vertex_slots()),
        to_(mesh.vertex_slots()),
        share_of_(mesh.vertex_slots()) {
    runtime::parallel_for(executor, from_.size(), [&](std::size_t i) {
      const auto v = static_cast<VertexId>(i);
      from_[v] = mean_log_around(mesh, v);
      to_[v] = background.log_metric(v);
      share_of_[v] = volume_around(mesh, v) / (Dim + 1);
    });
    const auto elements = static_cast<double>(background.element_count());
    most_complexity_ =
        3 * std::max(complexity_of_elements(Dim, elements), background.complexity(executor));
    steps_ = static_cast<int>(
        std::clamp(std::ceil(mean_log_stretch(by_demand) / std::log(longest_step)), 1.0, 20.0));
  }

  int steps() const { return steps_; }

  /// Gives the background the metric after so many steps; the last one is the target. It is the
  /// log-Euclidean mean. Where flat elements lie beside large ones that may ask for many more
  /// elements than either end; then all sizes are enlarged by one factor.
  void go_to(int step) {
    if (step == steps_) return set([&](std::size_t v) { return to_[v]; });
    const double share = static_cast<double>(step) / steps_;
    set([&](std::size_t v) { return between(v, share); });
    const double too_many = background_.complexity(executor_) / most_complexity_;
    if (!(too_many > 1)) return;
    const double larger = 2 * std::log(too_many) / Dim;
    set([&](std::size_t v) {
      Metric<Space> metric = between(v, share);
      for (std::size_t i = 0; i < Space; ++i) metric.m[i * (i + 3) / 2] -= larger;  // its diagonal
      return metric;
    });
  }

 private:
  static constexpr double longest_step = 3;  ///< factor by which a ratio of sizes may change

  Metric<Space> between(std::size_t v, double share) const {
    Metric<Space> metric = share * to_[v];
    metric += (1 - share) * from_[v];
    return metric;
  }

  void set(const auto& log_metric_of) {
    runtime::parallel_for(executor_, to_.size(), [&](std::size_t v) {
      background_.log_metric(static_cast<VertexId>(v)) = log_metric_of(v);
    });
  }

  double mean_log_stretch(bool by_demand) const {
    struct Sum {
      double weights = 0, all = 0;
    };
    const auto at_vertex = [&](std::size_t v) {
      const double weight = by_demand ? share_of_[v] * std::exp(log_density_of_log(to_[v])) : 1;
      return Sum{weight, weight * log_stretch(v)};
    };
    const Sum sum = runtime::parallel_reduce(executor_, to_.size(), Sum{}, at_vertex,
                                             [](const Sum& a, const Sum& b) {
                                               return Sum{a.weights + b.weights, a.all + b.all};
                                             });
    return sum.all / sum.weights;
  }

  static double volume_around(const Mesh<Dim, Space>& mesh, VertexId v) {
    double sum = 0;
    for (const ElementId element : mesh.elements_of.of(v))
      sum += volume_of(positions(mesh, element));
    return sum;
  }

  static double volume_of(const std::array<Vector<Space>, Dim + 1>& corner) {
    if constexpr (Dim < Space)
      return certain_area(corner[0], corner[1], corner[2]) / 2;
    else
      return certain_determinant<Dim>(corner) / (Dim == 2 ? 2 : 6);
  }

  static std::array<Vector<Space>, Dim + 1> positions(const Mesh<Dim, Space>& mesh,
                                                      ElementId element) {
    std::array<Vector<Space>, Dim + 1> corner;
    for (std::size_t c = 0; c <= Dim; ++c)
      corner[c] = mesh.site_of[mesh.corners_of[element][c]].position;
    return corner;
  }

  static Metric<Space> mean_log_around(const Mesh<Dim, Space>& mesh, VertexId v) {
    Metric<Space> sum;
    const auto around = mesh.elements_of.of(v);
    for (const ElementId element : around)
      sum += logarithm(metric_of_element<Dim>(positions(mesh, element)));
    return 1 / static_cast<double>(std::max<std::size_t>(1, around.size())) * sum;
  }

  /// Logarithm of the factor by which the ratio of two sizes changes most.
  double log_stretch(std::size_t v) const {
    Metric<Space> change = to_[v];
    change += -1.0 * from_[v];
    const PrincipalAxes<Space> axes = principal_axes(change);
    const auto [least, most] = std::minmax_element(axes.value.begin(), axes.value.end());
    return (*most - *least) / 2;
  }

  const runtime::Executor& executor_;
  Background<Dim, Space>& background_;
  std::vector<Metric<Space>> from_, to_;  // [vertex of the background], logarithms
  std::vector<double> share_of_;          // [vertex of the background], of the volume
  double most_complexity_ = 0;
  int steps_ = 1;
};

}  // namespace ductile::meshadapt
