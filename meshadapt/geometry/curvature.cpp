#include "geometry/curvature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/bends.hpp"

namespace ductile::meshadapt {

namespace {

/// By how much a metric has to be multiplied so that it measures no less than a tensor.
template <int Dim>
double excess(const Metric<Dim>& tensor, const Metric<Dim>& metric) {
  const PrincipalAxes<Dim> axes = principal_axes(metric);
  Metric<Dim> seen;  // the tensor where the metric is the unit tensor
  std::size_t at = 0;
  for (std::size_t j = 0; j < Dim; ++j)
    for (std::size_t i = 0; i <= j; ++i)
      seen.m[at++] = dot(axes.vector[i], product(tensor, axes.vector[j])) /
                     std::sqrt(axes.value[i] * axes.value[j]);
  const auto values = principal_axes(seen).value;
  return *std::max_element(values.begin(), values.end());
}

template <int Dim>
double largest_value(const Metric<Dim>& tensor) {
  const auto values = principal_axes(tensor).value;
  return *std::max_element(values.begin(), values.end());
}

/// No less than the largest of the absolute eigenvalues.
template <int Dim>
double frobenius_norm(const Metric<Dim>& tensor) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) sum += tensor(i, j) * tensor(i, j);
  return std::sqrt(sum);
}

/// A tensor after the least rotation that takes one unit vector to another, not the opposite one.
template <int Dim>
Metric<Dim> turned(const Metric<Dim>& tensor, const Vector<Dim>& from, const Vector<Dim>& to) {
  const Vector<Dim> sum = from + to;
  const double scale = 1 / (1 + dot(from, to));
  std::array<Vector<Dim>, Dim> axis;  // where each comes from
  for (int i = 0; i < Dim; ++i) {
    axis[static_cast<std::size_t>(i)][i] = 1;
    axis[static_cast<std::size_t>(i)] += 2 * to[i] * from - (scale * sum[i]) * sum;
  }
  Metric<Dim> result;
  std::size_t at = 0;
  for (std::size_t j = 0; j < Dim; ++j) {
    const Vector<Dim> seen = product(tensor, axis[j]);
    for (std::size_t i = 0; i <= j; ++i) result.m[at++] = dot(axis[i], seen);
  }
  return result;
}

/// Is it at a rim that bends nowhere itself, as at the end of an arc?
template <int Dim>
bool ends_across(const BendNode<Dim>& node) {
  return node.at_rim && frobenius_norm(node.turn) <= 1e-7 * std::pow(node.area, (Dim - 2) / 2.0);
}

/// How a smooth patch bends around a node, up to a distance to which chords stay close to it.
template <int Dim>
class Surroundings {
 public:
  Surroundings(const Mesh<Dim>& mesh, const Bends<Dim>& bends, double tolerance)
      : mesh_(mesh), bends_(bends), tolerance_(tolerance), seen_(bends.nodes.size(), none) {}

  /// A tensor in which edges as long as the boundary allows have length 1, if it can say so within
  /// `reach`; one that is too small where they may be longer.
  Metric<Dim> sizes_at(std::uint32_t node, double reach) {
    front_.clear();
    found_.clear();
    interior_ = at_rim_ = {};
    normal_ = bends_.nodes[node].normal;
    origin_ = position(node);
    see(node, node);
    Metric<Dim> curvature;
    for (double distance = 0; !front_.empty() && found_.size() < most_nodes;) {
      std::pop_heap(front_.begin(), front_.end(), farther);
      const auto [away, nearest] = front_.back();
      front_.pop_back();
      distance = away;
      if (distance > reach) break;
      take(node, nearest, distance);
      curvature = (interior_.area > 0 ? interior_ : at_rim_).curvature();
      if (is_enough(frobenius_norm(curvature), distance) &&
          is_enough(largest_value(absolute(curvature)), distance))
        break;
    }
    return sizes(absolute(curvature));
  }

 private:
  /// What so many vertices say is not better for more.
  static constexpr std::size_t most_nodes = 100;
  /// Of chords as long as may be, up to where the surface is looked at from their ends: where
  /// edges are as long, this reaches the next vertices, among which what bends to and fro cancels.
  static constexpr double chords = 1.25;
  struct Part {
    Metric<Dim> turn;
    double area = 0;
    Metric<Dim> curvature() const { return area > 0 ? (1 / area) * turn : turn; }
  };
  using Place = std::pair<double, std::uint32_t>;  // distance, node

  static bool farther(const Place& a, const Place& b) { return a > b; }
  const Vector<Dim>& position(std::uint32_t node) const {
    return mesh_.site_of[bends_.nodes[node].vertex].position;
  }

  void see(std::uint32_t from, std::uint32_t node) {
    if (std::exchange(seen_[node], from) == from) return;
    front_.emplace_back(norm(position(node) - origin_), node);
    std::push_heap(front_.begin(), front_.end(), farther);
  }

  void take(std::uint32_t from, std::uint32_t node, double distance) {
    found_.emplace_back(distance, node);
    const BendNode<Dim>& found = bends_.nodes[node];
    Part& part = found.at_rim ? at_rim_ : interior_;
    const double side = dot(found.normal, normal_) < 0 ? -1 : 1;
    part.turn += side * turned(found.turn, side * found.normal, normal_);
    part.area += found.area;
    const auto& [offset, neighbour] = bends_.next;
    for (std::uint32_t i = offset[node]; i < offset[node + 1]; ++i) see(from, neighbour[i]);
  }

  /// Is the distance that of the chords that a curvature allows, see bound_curved_sizes()?
  bool is_enough(double curvature, double distance) const {
    return curvature * distance * distance >= 8 * tolerance_ * chords * chords;
  }

  /// Not smaller than the flat parts around: to divide these brings nothing closer.
  Metric<Dim> sizes(Metric<Dim> curvature) const {
    const double most = largest_value(curvature);
    if (!(most > 0)) return {};
    const double chord = std::sqrt(8 * tolerance_ / most);
    double least = 2 * tolerance_;
    for (const auto& [distance, node] : found_)
      if (distance <= chord / 2 || found_.size() < 8) {
        least = std::max(least, bends_.nodes[node].width);
        const auto& [offset, neighbour] = bends_.next;
        for (std::uint32_t i = offset[node]; i < offset[node + 1]; ++i)
          least = std::max(least, norm(position(neighbour[i]) - position(node)));
      }
    const double scale = std::min(1.0, chord / least);
    curvature *= scale * scale / (8 * tolerance_);
    return curvature;
  }

  const Mesh<Dim>& mesh_;
  const Bends<Dim>& bends_;
  double tolerance_;
  std::vector<std::uint32_t> seen_;  // [node], from which it was seen last
  std::vector<Place> front_, found_;
  Part interior_, at_rim_;
  Vector<Dim> normal_, origin_;
};

}  // namespace

template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of) {
  constexpr double flat = 0.02;  // of the tolerance: a tenth of the longest chord on an arc
  const Bends<Dim> bends(executor, mesh, flat * tolerance);
  const auto& nodes = bends.nodes;
  std::vector<double> factor_of(nodes.size(), 1);
  const std::size_t block_size = std::max<std::size_t>(1024, nodes.size() / 64);
  runtime::parallel_for_blocks(
      executor, nodes.size(), block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
        Surroundings<Dim> surroundings(mesh, bends, tolerance);
        for (std::size_t n = begin; n < end; ++n) {
          if (ends_across(nodes[n])) continue;
          const Metric<Dim>& metric = metric_of[nodes[n].vertex];
          const auto values = principal_axes(metric).value;
          const double largest = 1 / std::sqrt(*std::min_element(values.begin(), values.end()));
          const auto sizes = surroundings.sizes_at(static_cast<std::uint32_t>(n), largest);
          const double factor = excess(sizes, metric);
          if (factor > 1 && std::isfinite(factor)) factor_of[n] = factor;
        }
      });
  std::vector<double> most(metric_of.size(), 1);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    most[nodes[n].vertex] = std::max(most[nodes[n].vertex], factor_of[n]);
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    if (most[v] > 1) metric_of[v] *= most[v];
  });
}

template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                 std::vector<Metric<2>>&);
template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                 std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
