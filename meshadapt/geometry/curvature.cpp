#include "geometry/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/bends.hpp"
#include "geometry/curvature_fit.hpp"
#include "geometry/curve_bend.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
double smallest_value(const Metric<Dim>& tensor) {
  const auto values = principal_axes(tensor).value;
  return *std::min_element(values.begin(), values.end());
}

/// How a smooth patch bends around a node, up to a distance to which chords stay close to it.
template <int Dim>
class Surroundings {
 public:
  Surroundings(const Mesh<Dim>& mesh, const Bends<Dim>& bends, double tolerance)
      : mesh_(mesh), bends_(bends), tolerance_(tolerance), seen_(bends.nodes.size(), none) {}

  /// A tensor in which edges as long as the boundary allows have length 1, if it can say so within
  /// `reach`; one that is too small where they may be longer. Where it bends enough for chords,
  /// that may be noise: a fit that bends less counts if it explains all that is within 1.5 times as
  /// far.
  Metric<Dim> sizes_at(std::uint32_t node, double reach) {
    constexpr double farther_away = 1.5;
    front_.clear();
    found_.clear();
    origin_ = position(node);
    bend_ = CurvatureFit<Dim>(normal_at(node));
    see(node, node);
    PrincipalAxes<Dim> curvature = bend_.curvature();
    double limit = reach;
    bool bends_enough = false;
    while (!front_.empty() && found_.size() < most_nodes) {
      std::pop_heap(front_.begin(), front_.end(), farther);
      const auto [distance, nearest] = front_.back();
      front_.pop_back();
      if (distance > limit) break;
      take(node, nearest, distance);
      if (bends_enough) continue;
      curvature = bend_.curvature();
      bends_enough = found_.size() > fewest_nodes && is_enough(largest(curvature), distance);
      if (bends_enough) limit = farther_away * distance;
    }
    const PrincipalAxes<Dim> smoother = bend_.curvature();
    const bool is_rough = largest(smoother) < largest(curvature) && explains_all();
    return sizes(is_rough ? smoother : curvature);
  }

 private:
  /// More vertices than this do not improve a fit.
  static constexpr std::size_t most_nodes = 100;
  /// So many beside the node give directions.
  static constexpr std::size_t fewest_nodes = Dim == 2 ? 2 : 6;
  /// The distance, in longest allowed chords, up to which vertices are used: where edges are that
  /// long, it reaches the next vertices, among which bends to and fro cancel.
  static constexpr double chords = 1.25;
  using Place = std::pair<double, std::uint32_t>;  // distance, node

  static bool farther(const Place& a, const Place& b) { return a > b; }
  const Vector<Dim>& position(std::uint32_t node) const {
    return mesh_.site_of[bends_.nodes[node].vertex].position;
  }

  /// That of a node. Among needles it may say nothing: where the largest part beside the node is
  /// turned by 45 degrees against it, that part's.
  const Vector<Dim>& normal_at(std::uint32_t node) const {
    constexpr double least_turn = 0.7;
    const auto& [offset, neighbour] = bends_.next;
    std::uint32_t widest = node;
    for (std::uint32_t i = offset[node]; i < offset[node + 1]; ++i)
      if (bends_.nodes[neighbour[i]].area > bends_.nodes[widest].area) widest = neighbour[i];
    const auto &own = bends_.nodes[node].normal, &wide = bends_.nodes[widest].normal;
    return std::abs(dot(own, wide)) < least_turn ? wide : own;
  }

  void see(std::uint32_t from, std::uint32_t node) {
    if (std::exchange(seen_[node], from) == from) return;
    front_.emplace_back(norm(position(node) - origin_), node);
    std::push_heap(front_.begin(), front_.end(), farther);
  }

  void take(std::uint32_t from, std::uint32_t node, double distance) {
    found_.emplace_back(distance, node);
    const BendNode<Dim>& found = bends_.nodes[node];
    bend_.add(position(node) - origin_, found.normal, found.area);
    const auto& [offset, neighbour] = bends_.next;
    for (std::uint32_t i = offset[node]; i < offset[node + 1]; ++i) see(from, neighbour[i]);
  }

  /// Are all places as high as the fit says, within half of the tolerance?
  bool explains_all() const {
    double low = std::numeric_limits<double>::max(), high = -low;
    const auto height = bend_.height();
    for (const auto& [distance, node] : found_) {
      const double h = height(position(node) - origin_);
      low = std::min(low, h);
      high = std::max(high, h);
    }
    return high - low <= tolerance_;
  }

  /// Is the distance that of the chords that a curvature allows, see bound_curved_sizes()?
  bool is_enough(double curvature, double distance) const {
    return curvature * distance * distance >= 8 * tolerance_ * chords * chords;
  }

  static double largest(const PrincipalAxes<Dim>& axes) {
    return *std::max_element(axes.value.begin(), axes.value.end());
  }

  /// Chords in the directions in which it bends most and least; across the surface, the first axis,
  /// as in the direction in which it bends most.
  Metric<Dim> sizes(PrincipalAxes<Dim> axes) const {
    const double most = largest(axes);
    if (!(most > 0)) return {};
    const double near = std::sqrt(8 * tolerance_ / most) / 2;
    axes.value[0] = 0;
    for (std::size_t i = 1; i < Dim; ++i) {
      const double size =
          std::max(std::sqrt(8 * tolerance_ / axes.value[i]), least_size(axes.vector[i], near));
      axes.value[i] = 1 / (size * size);
      axes.value[0] = std::max(axes.value[0], axes.value[i]);
    }
    return compose(axes);
  }

  /// In a direction, that of the flat parts around: to divide these brings nothing closer.
  double least_size(const Vector<Dim>& direction, double near) const {
    double least = 2 * tolerance_;
    for (const auto& [distance, node] : found_) {
      if (distance > near && found_.size() >= 8) continue;
      least = std::max(least, bends_.nodes[node].width);
      const auto& [offset, neighbour] = bends_.next;
      for (std::uint32_t i = offset[node]; i < offset[node + 1]; ++i)
        least = std::max(least, extent(position(neighbour[i]) - position(node), direction));
    }
    return least;
  }

  /// The length of an edge that goes about in a direction; of another one, how far it goes in it.
  static double extent(const Vector<Dim>& edge, const Vector<Dim>& direction) {
    const double length = norm(edge), along = std::abs(dot(edge, direction));
    return along > length / 2 ? length : along;
  }

  const Mesh<Dim>& mesh_;
  const Bends<Dim>& bends_;
  double tolerance_;
  std::vector<std::uint32_t> seen_;  // [node], from which it was seen last
  std::vector<Place> front_, found_;
  CurvatureFit<Dim> bend_;
  Vector<Dim> origin_;
};

/// The metric made as fine as a tensor, which may ask for nothing in some directions.
template <int Dim>
Metric<Dim> bounded(const Metric<Dim>& metric, const Metric<Dim>& tensor) {
  const double least = smallest_value(metric);
  PrincipalAxes<Dim> axes = principal_axes(tensor);
  bool binds = false;
  for (double& value : axes.value) {
    if (!std::isfinite(value)) return metric;
    binds = binds || value > least;
    value = std::max(value, least);
  }
  return binds ? intersect(metric, compose(axes)) : metric;
}

template <int Dim>
void bound_on_patches(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                      std::vector<Metric<Dim>>& metric_of) {
  constexpr double flat = 0.02;  // of the tolerance: a tenth of the longest chord on an arc
  const Bends<Dim> bends(executor, mesh, flat * tolerance);
  const auto& nodes = bends.nodes;
  std::vector<Metric<Dim>> sizes_of(nodes.size());
  const std::size_t block_size = std::max<std::size_t>(1024, nodes.size() / 64);
  runtime::parallel_for_blocks(
      executor, nodes.size(), block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
        Surroundings<Dim> surroundings(mesh, bends, tolerance);
        for (std::size_t n = begin; n < end; ++n) {
          const double largest = 1 / std::sqrt(smallest_value(metric_of[nodes[n].vertex]));
          sizes_of[n] = surroundings.sizes_at(static_cast<std::uint32_t>(n), largest);
        }
      });
  for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end) {
    while (end < nodes.size() && nodes[end].patch == nodes[begin].patch) ++end;
    runtime::parallel_for(executor, end - begin, [&](std::size_t i) {
      Metric<Dim>& metric = metric_of[nodes[begin + i].vertex];  // once in each patch
      metric = bounded(metric, sizes_of[begin + i]);
    });
  }
}

void bound_on_curves(const runtime::Executor&, const Mesh<2>&, double, std::vector<Metric<2>>&) {}
void bound_on_curves(const runtime::Executor& executor, const Mesh<3>& mesh, double tolerance,
                     std::vector<Metric<3>>& metric_of) {
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    const auto vertex = static_cast<VertexId>(v);
    if (mesh.kind_of[v].class_dimension > 1 || !mesh.vertex_alive(vertex)) return;
    for (const CurveLink& link : mesh.links_of.of(vertex)) {
      if (!mesh.curves[link.curve].smooth) continue;
      const double largest = 1 / std::sqrt(smallest_value(metric_of[v]));
      metric_of[v] =
          bounded(metric_of[v], CurveBend(mesh, vertex, link.curve).sizes(tolerance, largest));
    }
  });
}

}  // namespace

template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of) {
  bound_on_patches(executor, mesh, tolerance, metric_of);
  bound_on_curves(executor, mesh, tolerance, metric_of);
}

template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                 std::vector<Metric<2>>&);
template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                 std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
