#include "operators/background.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/unit.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/walk.hpp"
#include "metric/interpolation.hpp"

namespace ductile::meshadapt {

namespace {

/// How far below 0 a barycentric weight may be for a point to count as inside of the element in
/// which a walk ends: by rounding, or by more where curved boundaries may move.
constexpr double rounding = 1e-5, close_outside = 0.25;

}  // namespace

template <int Dim, int Space>
Background<Dim, Space>::Background(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                                   Neighbours<Dim> neighbours)
    : neighbours_(std::move(neighbours)), slack_(mesh.surface ? close_outside : rounding) {
  runtime::FreshMemory fresh;
  corners_of_.resize_for_overwrite(mesh.element_slots(), fresh);
  position_of_.resize_for_overwrite(mesh.vertex_slots(), fresh);
  log_metric_of_.resize_for_overwrite(mesh.vertex_slots(), fresh);
  fresh.touch(executor);
  runtime::parallel_for(executor, mesh.element_slots(),
                        [&](std::size_t e) { corners_of_[e] = mesh.corners_of[e]; });
  runtime::parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    position_of_[v] = mesh.site_of[v].position;
    log_metric_of_[v] = logarithm(mesh.site_of[v].metric);
  });
}

template <int Dim, int Space>
Background<Dim, Space>::~Background() = default;

template <int Dim, int Space>
void Background<Dim, Space>::release(const runtime::Executor& executor) {
  runtime::SpentMemory spent;
  corners_of_.release(spent);
  neighbours_.release(spent);
  position_of_.release(spent);
  log_metric_of_.release(spent);
  spent.give_back(executor);
}

/// The tree is made by the thread that needs it first, on its own: the others are busy.
template <int Dim, int Space>
ClosestPoint<Dim> Background<Dim, Space>::closest(const Vector<Space>& point) const {
  const auto make = [&] {
    return std::make_unique<BoxTree<Dim, Space>>(runtime::Executor({.threads = 1}),
                                                 Simplices<Dim, Space>{corners_of_, position_of_});
  };
  return tree_.get(make)->closest(point);
}

template <int Dim, int Space>
auto Background<Dim, Space>::sample(const Vector<Space>& point, ElementId near) const -> Sample {
  if (near >= corners_of_.size()) near = 0;
  const WalkEnd<Dim> end =
      walk<Dim, Space>({{corners_of_, position_of_}, neighbours_}, point, near);
  ElementId host = end.element;
  Weights<Dim> weight = end.weight;
  // Not so either if they are no numbers, as of an element that is flat but for rounding.
  const auto is_near = [&](double w) { return w >= -slack_; };
  if (is_far_off(end.element, point) ||
      (!end.inside && !std::all_of(weight.begin(), weight.end(), is_near))) {
    const ClosestPoint<Dim> found = closest(point);
    host = found.element;
    weight = found.weight;
  }
  double sum = 0;
  for (double& w : weight) sum += w = std::max(w, 0.0);
  const double scale = 1 / sum;
  CornerLogs<Dim, Space> logs;
  for (std::size_t i = 0; i <= Dim; ++i) {
    weight[i] *= scale;
    logs[i] = &log_metric_of_[corners_of_[host][i]];
  }
  return {host, interpolated<Dim, Space>(logs, weight, [&] { return places_of(host); })};
}

/// A walk over a surface may end on another sheet than the one that is closest.
template <int Dim, int Space>
bool Background<Dim, Space>::is_far_off(ElementId element, const Vector<Space>& point) const {
  if constexpr (Dim < Space) {
    constexpr double far = 0.1;  // of the square root of the triangle's area, about
    const auto corner = places_of(element);
    const Vector<3> normal = facet_normal(corner);
    const double height = std::abs(dot(point - corner[0], normal)), size = norm(normal);
    return !(height * height <= far * far * size * size * size);
  }
  return false;
}

template <int Dim, int Space>
std::array<Vector<Space>, Dim + 1> Background<Dim, Space>::places_of(ElementId element) const {
  std::array<Vector<Space>, Dim + 1> corner;
  for (std::size_t i = 0; i <= Dim; ++i) corner[i] = position_of_[corners_of_[element][i]];
  return corner;
}

template <int Dim, int Space>
double Background<Dim, Space>::complexity(const runtime::Executor& executor) const {
  const auto of_element = [&](std::size_t e) {
    const auto corner = places_of(static_cast<ElementId>(e));
    LogDensities<Dim> densities;
    for (std::size_t i = 0; i <= Dim; ++i) {
      const Metric<Space>& log_metric = log_metric_of_[corners_of_[e][i]];
      if constexpr (Dim < Space)
        densities[i] = log_density_in_plane(exponential(log_metric), unit(facet_normal(corner)));
      else
        densities[i] = log_density_of_log(log_metric);
    }
    return complexity_of_element<Dim>(densities, corner);
  };
  return runtime::parallel_reduce(executor, corners_of_.size(), 0.0, of_element, std::plus<>());
}

template <int Dim, int Space>
std::size_t Background<Dim, Space>::bytes() const {
  const auto* tree = tree_.made();
  return corners_of_.bytes() + neighbours_.bytes() + position_of_.bytes() + log_metric_of_.bytes() +
         (tree == nullptr ? 0 : (*tree)->bytes());
}

template class Background<2>;
template class Background<2, 3>;
template class Background<3>;

}  // namespace ductile::meshadapt
