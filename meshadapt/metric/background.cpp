#include "ductile/meshadapt/background.hpp"

#include <algorithm>
#include <limits>

#include "ductile/runtime/parallel_for.hpp"
#include "mesh/walk.hpp"

namespace ductile::meshadapt {

namespace {

/// The element that the point is in, or least outside of.
template <int Dim>
WalkEnd<Dim> search(const Walkable<Dim>& mesh, const Vector<Dim>& point) {
  WalkEnd<Dim> best{0, barycentric(mesh, 0, point), true};
  double best_lowest = -std::numeric_limits<double>::infinity();
  for (ElementId e = 0; e < mesh.corners_of.size() && best_lowest < -walk_tolerance; ++e) {
    const Weights<Dim> weight = barycentric(mesh, e, point);
    const double lowest = *std::min_element(weight.begin(), weight.end());
    if (lowest > best_lowest) {
      best_lowest = lowest;
      best = {e, weight, true};
    }
  }
  return best;
}

}  // namespace

template <int Dim>
Background<Dim>::Background(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                            Neighbours<Dim> neighbours, const std::vector<Metric<Dim>>& metric_of)
    : corners_of_(mesh.corners_of),
      neighbours_(std::move(neighbours)),
      position_of_(mesh.vertex_slots()),
      log_metric_of_(mesh.vertex_slots()) {
  runtime::parallel_for(executor, mesh.vertex_slots(), [&](std::size_t v) {
    position_of_[v] = mesh.site_of[v].position;
    log_metric_of_[v] = logarithm(metric_of[v]);
  });
}

template <int Dim>
auto Background<Dim>::sample(const Vector<Dim>& point, ElementId near) const -> Sample {
  const Walkable<Dim> mesh{corners_of_, neighbours_, position_of_};
  WalkEnd<Dim> at = walk(mesh, point, near);
  if (!at.inside) {
    const double lowest = *std::min_element(at.weight.begin(), at.weight.end());
    if (lowest < -1e-5) at = search(mesh, point);
  }
  double sum = 0;
  for (double& w : at.weight) sum += w = std::max(w, 0.0);
  Metric<Dim> log_metric;
  for (std::size_t i = 0; i <= Dim; ++i) {
    const double w = at.weight[i] / sum;
    if (w > 0) log_metric += w * log_metric_of_[corners_of_[at.element][i]];
  }
  return {at.element, exponential(log_metric)};
}

template <int Dim>
std::size_t Background<Dim>::bytes() const {
  return corners_of_.capacity() * sizeof(corners_of_[0]) +
         neighbours_.capacity() * sizeof(neighbours_[0]) +
         position_of_.capacity() * sizeof(position_of_[0]) +
         log_metric_of_.capacity() * sizeof(log_metric_of_[0]);
}

template class Background<2>;
template class Background<3>;

}  // namespace ductile::meshadapt
