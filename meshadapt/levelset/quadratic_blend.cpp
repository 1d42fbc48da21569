#include "levelset/quadratic_blend.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/meshadapt/hessian_metric.hpp"
#include "levelset/level_set_gradients.hpp"

namespace ductile::meshadapt {

template <int Dim>
QuadraticBlend<Dim>::QuadraticBlend(const runtime::Executor& executor, FixedMesh<Dim> mesh,
                                    std::vector<double> value_of)
    : mesh_(std::move(mesh)),
      value_of_(std::move(value_of)),
      gradient_of_(recover_gradient<Dim>(executor, mesh_, value_of_)),
      locator_(executor, mesh_) {
  std::vector<VertexId> near_zero;
  for (VertexId v = 0; v < mesh_.vertex_count(); ++v)
    if (is_near_zero(v)) near_zero.push_back(v);
  const auto better = level_set_gradients<Dim>(executor, mesh_, value_of_, near_zero);
  for (std::size_t i = 0; i < near_zero.size(); ++i) gradient_of_[near_zero[i]] = better[i];
  set_starts(executor);
}

/// Is a value of the other sign next to it?
template <int Dim>
bool QuadraticBlend<Dim>::is_near_zero(VertexId vertex) const {
  for (const ElementId e : mesh_.elements_of(vertex))
    for (const VertexId other : mesh_.corners_of[e])
      if ((value_of_[other] < 0) != (value_of_[vertex] < 0)) return true;
  return false;
}

/// About as many cells as elements.
template <int Dim>
void QuadraticBlend<Dim>::set_starts(const runtime::Executor& executor) {
  box_ = Box<Dim>::empty();
  for (const Vector<Dim>& point : mesh_.position_of) box_ = join(box_, {point, point});
  double volume = 1;
  for (int i = 0; i < Dim; ++i) volume *= box_.high[i] - box_.low[i];
  const double size = std::pow(volume / static_cast<double>(mesh_.element_count()), 1.0 / Dim);
  std::size_t count = 1;
  for (int i = 0; i < Dim; ++i) {
    const double cells = std::ceil((box_.high[i] - box_.low[i]) / size);
    count *= cells_[static_cast<std::size_t>(i)] =
        static_cast<std::size_t>(std::clamp(cells, 1.0, 1024.0));
  }
  start_of_.resize(count);
  walk_in_blocks(executor, count, [&](std::size_t cell, ElementId near) {
    Vector<Dim> centre;
    std::size_t rest = cell;
    for (int i = 0; i < Dim; ++i) {
      const std::size_t cells = cells_[static_cast<std::size_t>(i)];
      const double place = (static_cast<double>(rest % cells) + 0.5) / static_cast<double>(cells);
      centre[i] = box_.low[i] + place * (box_.high[i] - box_.low[i]);
      rest /= cells;
    }
    return start_of_[cell] = locator_.find(centre, near).element;
  });
}

template <int Dim>
ElementId QuadraticBlend<Dim>::start_near(const Vector<Dim>& point) const {
  std::size_t cell = 0;
  for (int i = Dim; i-- > 0;) {
    const auto cells = static_cast<double>(cells_[static_cast<std::size_t>(i)]);
    const double place = (point[i] - box_.low[i]) / (box_.high[i] - box_.low[i]);
    cell = cell * cells_[static_cast<std::size_t>(i)] +
           static_cast<std::size_t>(std::clamp(place * cells, 0.0, cells - 1));
  }
  return start_of_[cell];
}

template <int Dim>
auto QuadraticBlend<Dim>::at(const Vector<Dim>& point, ElementId near) const -> Sample {
  if (near == none) near = start_near(point);
  Sample sample{0, {}, locator_.find(point, near).element};
  const auto corner = mesh_.points(sample.element);
  const auto weight = barycentric<Dim>(corner, point);
  const auto hat = hat_gradients<Dim>(corner);
  for (std::size_t i = 0; i <= Dim; ++i) {
    const VertexId vertex = mesh_.corners_of[sample.element][i];
    const double from_here = value_of_[vertex] + 0.5 * dot(gradient_of_[vertex], point - corner[i]);
    sample.value += weight[i] * from_here;
    sample.gradient += from_here * hat[i] + (0.5 * weight[i]) * gradient_of_[vertex];
  }
  return sample;
}

template <int Dim>
std::optional<Vector<Dim>> QuadraticBlend<Dim>::closest(const Vector<Dim>& point,
                                                        double within) const {
  constexpr int most_steps = 12;
  constexpr double rounding = 1e-14;  // of the element
  Vector<Dim> at_zero = point;
  ElementId near = none;
  for (int step = 0; step < most_steps; ++step) {
    const Sample sample = at(at_zero, near);
    const double square = dot(sample.gradient, sample.gradient);
    if (!(square > 0)) return {};
    const Vector<Dim> move = (-sample.value / square) * sample.gradient;
    at_zero += move;
    if (!(norm(at_zero - point) <= within)) return {};
    near = sample.element;
    const double size = std::pow(mesh_.volume_of[near], 1.0 / Dim);
    if (norm(move) <= rounding * size) return at_zero;
  }
  return {};
}

template <int Dim>
Metric<Dim> QuadraticBlend<Dim>::chords(const Vector<Dim>& point, double distance) const {
  constexpr double least_turn = 0.7;  // cosine of the angle between gradients across a kink
  const Sample here = at(point, none);
  const double slope = norm(here.gradient);
  if (!(slope > 0)) return {};
  const Vector<Dim> normal = (1 / slope) * here.gradient;
  const double step = 0.5 * std::pow(mesh_.volume_of[here.element], 1.0 / Dim);
  const auto flat = [&](const Vector<Dim>& d) { return d - dot(d, normal) * normal; };
  Metric<Dim> bend;
  for (int i = 0; i < Dim; ++i) {
    Vector<Dim> axis;
    axis[i] = 1;
    const Vector<Dim> along = flat(axis);
    const Vector<Dim> ahead = at(point + step * along, here.element).gradient;
    const Vector<Dim> behind = at(point - step * along, here.element).gradient;
    if (dot(ahead, behind) < least_turn * norm(ahead) * norm(behind)) return {};
    const Vector<Dim> turn = flat((1 / (2 * step * slope)) * (ahead - behind));
    for (int j = 0; j <= i; ++j) bend.m[static_cast<std::size_t>(i * (i + 1) / 2 + j)] += turn[j];
  }
  PrincipalAxes<Dim> axes = principal_axes(bend);
  double most = 0;
  const double finest = 1 / (16 * distance * distance);
  for (double& value : axes.value)
    most = std::max(most, value = std::min(std::abs(value) / (8 * distance), finest));
  for (std::size_t i = 0; i < Dim; ++i)
    if (std::abs(dot(axes.vector[i], normal)) > least_turn) axes.value[i] = most;
  return compose(axes);
}

template class QuadraticBlend<2>;
template class QuadraticBlend<3>;

}  // namespace ductile::meshadapt
