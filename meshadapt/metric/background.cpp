#include "ductile/meshadapt/background.hpp"

#include <algorithm>
#include <limits>

#include "ductile/runtime/parallel_for.hpp"

namespace ductile::meshadapt {

namespace {

/// A point this far outside, as a barycentric weight, still counts as inside: it is on the boundary
/// up to rounding.
constexpr double tolerance = 1e-9;

/// A walk that takes longer than this goes in circles or around a hole.
constexpr int longest_walk = 2000;

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
auto Background<Dim>::weights(ElementId element, const Vector<Dim>& point) const -> Weights {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = position_of_[corners_of_[element][i]];
  Weights weight;
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector<Dim> corner = std::exchange(p[i], point);
    weight[i] = plain_determinant(p);
    p[i] = corner;
    sum += weight[i];
  }
  for (double& w : weight) w /= sum;
  return weight;
}

/// Steps over the facet that the point is farthest behind, until it is behind none.
template <int Dim>
auto Background<Dim>::walk(const Vector<Dim>& point, ElementId near) const -> Walk {
  Walk at{near, {}, false};
  for (int step = 0; step < longest_walk; ++step) {
    at.weight = weights(at.element, point);
    ElementId next = none;
    double lowest = -tolerance;
    bool inside = true;
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (at.weight[i] >= -tolerance) continue;
      inside = false;
      if (at.weight[i] < lowest && neighbours_[at.element][i] != none) {
        lowest = at.weight[i];
        next = neighbours_[at.element][i];
      }
    }
    at.inside = inside;
    if (next == none) break;
    at.element = next;
  }
  return at;
}

/// The element that the point is in, or least outside of.
template <int Dim>
auto Background<Dim>::search(const Vector<Dim>& point) const -> Walk {
  Walk best{0, weights(0, point), true};
  double best_lowest = -std::numeric_limits<double>::infinity();
  for (ElementId e = 0; e < corners_of_.size() && best_lowest < -tolerance; ++e) {
    const Weights weight = weights(e, point);
    const double lowest = *std::min_element(weight.begin(), weight.end());
    if (lowest > best_lowest) {
      best_lowest = lowest;
      best = {e, weight, true};
    }
  }
  return best;
}

template <int Dim>
auto Background<Dim>::sample(const Vector<Dim>& point, ElementId near) const -> Sample {
  Walk at = walk(point, near);
  if (!at.inside) {
    const double lowest = *std::min_element(at.weight.begin(), at.weight.end());
    if (lowest < -1e-5) at = search(point);
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
