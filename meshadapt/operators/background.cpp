#include "operators/background.hpp"

#include <algorithm>
#include <functional>

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

template <int Dim>
Background<Dim>::Background(const runtime::Executor& executor, const Mesh<Dim>& mesh,
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

template <int Dim>
Background<Dim>::~Background() = default;

template <int Dim>
void Background<Dim>::release(const runtime::Executor& executor) {
  runtime::SpentMemory spent;
  corners_of_.release(spent);
  neighbours_.release(spent);
  position_of_.release(spent);
  log_metric_of_.release(spent);
  spent.give_back(executor);
}

/// The tree is made by the thread that needs it first, on its own: the others are busy.
template <int Dim>
ClosestPoint<Dim> Background<Dim>::closest(const Vector<Dim>& point) const {
  const auto make = [&] {
    return std::make_unique<BoxTree<Dim>>(runtime::Executor({.threads = 1}),
                                          Simplices<Dim>{corners_of_, position_of_});
  };
  return tree_.get(make)->closest(point);
}

template <int Dim>
auto Background<Dim>::sample(const Vector<Dim>& point, ElementId near) const -> Sample {
  if (near >= corners_of_.size()) near = 0;
  const WalkEnd<Dim> end = walk<Dim>({{corners_of_, position_of_}, neighbours_}, point, near);
  ElementId host = end.element;
  Weights<Dim> weight = end.weight;
  // Not so either if they are no numbers, as of an element that is flat but for rounding.
  const auto is_near = [&](double w) { return w >= -slack_; };
  if (!end.inside && !std::all_of(weight.begin(), weight.end(), is_near)) {
    const ClosestPoint<Dim> found = closest(point);
    host = found.element;
    weight = found.weight;
  }
  double sum = 0;
  for (double& w : weight) sum += w = std::max(w, 0.0);
  const double scale = 1 / sum;
  CornerLogs<Dim> logs;
  for (std::size_t i = 0; i <= Dim; ++i) {
    weight[i] *= scale;
    logs[i] = &log_metric_of_[corners_of_[host][i]];
  }
  return {host, interpolated<Dim>(logs, weight, [&] { return places_of(host); })};
}

template <int Dim>
std::array<Vector<Dim>, Dim + 1> Background<Dim>::places_of(ElementId element) const {
  std::array<Vector<Dim>, Dim + 1> corner;
  for (std::size_t i = 0; i <= Dim; ++i) corner[i] = position_of_[corners_of_[element][i]];
  return corner;
}

template <int Dim>
double Background<Dim>::complexity(const runtime::Executor& executor) const {
  const auto of_element = [&](std::size_t e) {
    LogDensities<Dim> densities;
    for (std::size_t i = 0; i <= Dim; ++i)
      densities[i] = log_density_of_log(log_metric_of_[corners_of_[e][i]]);
    return complexity_of_element<Dim>(densities, places_of(static_cast<ElementId>(e)));
  };
  return runtime::parallel_reduce(executor, corners_of_.size(), 0.0, of_element, std::plus<>());
}

template <int Dim>
std::size_t Background<Dim>::bytes() const {
  const auto* tree = tree_.made();
  return corners_of_.bytes() + neighbours_.bytes() + position_of_.bytes() + log_metric_of_.bytes() +
         (tree == nullptr ? 0 : (*tree)->bytes());
}

template class Background<2>;
template class Background<3>;

}  // namespace ductile::meshadapt
