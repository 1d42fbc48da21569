#include "mesh/box_tree.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "metric/small_system.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

constexpr std::size_t width = 4;

struct Keyed {
  std::uint64_t key;
  ElementId element;
  friend auto operator<=>(const Keyed&, const Keyed&) = default;
};

template <int Dim>
double squared_distance(const Box<Dim>& box, const Vector<Dim>& point) {
  double sum = 0;
  for (int i = 0; i < Dim; ++i) {
    const double beyond = std::max({box.low[i] - point[i], point[i] - box.high[i], 0.0});
    sum += beyond * beyond;
  }
  return sum;
}

/// The point closest to the origin among those that the chosen corners span: weights that add up
/// to 1, not all of them positive perhaps. False if the corners do not lie in general position.
template <int Dim>
bool closest_in_span(const std::array<Vector<Dim>, Dim + 1>& corner, unsigned chosen,
                     Weights<Dim>& weight) {
  std::size_t base = 0;
  while ((chosen >> base & 1U) == 0) ++base;
  SmallSystem<Dim> system;
  const auto moves = [&](std::size_t unknown) {
    return unknown + 1 > base && (chosen >> (unknown + 1) & 1U) != 0;
  };
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    std::array<double, Dim> row{};
    for (std::size_t i = 0; i < Dim; ++i)
      if (moves(i)) row[i] = corner[i + 1].x[axis] - corner[base].x[axis];
    system.add(row, {-corner[base].x[axis]});
  }
  for (std::size_t i = 0; i < Dim; ++i) {
    std::array<double, Dim> row{};
    row[i] = moves(i) ? 0 : 1;
    system.add(row, {0.0});
  }
  if (!system.solve(1e-13)) return false;
  weight = {};
  weight[base] = 1;
  for (std::size_t i = 0; i < Dim; ++i) {
    if (!moves(i)) continue;
    weight[i + 1] = system.solution(i);
    weight[base] -= weight[i + 1];
  }
  return true;
}

/// The point of an element closest to `point`: the best over the element, its facets, edges and
/// corners.
template <int Dim>
ClosestPoint<Dim> closest_in(std::array<Vector<Dim>, Dim + 1> corner, const Vector<Dim>& point) {
  ClosestPoint<Dim> best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (Vector<Dim>& p : corner) p -= point;
  for (unsigned chosen = 1; chosen < 1U << (Dim + 1); ++chosen) {
    Weights<Dim> weight;
    if (!closest_in_span<Dim>(corner, chosen, weight)) continue;
    if (*std::min_element(weight.begin(), weight.end()) < 0) continue;
    Vector<Dim> at;
    for (std::size_t i = 0; i <= Dim; ++i) at += weight[i] * corner[i];
    if (dot(at, at) >= best.squared_distance) continue;
    best.weight = weight;
    best.squared_distance = dot(at, at);
  }
  return best;
}

}  // namespace

template <int Dim>
BoxTree<Dim>::BoxTree(const Executor& executor, const Simplices<Dim>& mesh) : mesh_(mesh) {
  const auto all = runtime::parallel_reduce(
      executor, mesh.corners_of.size(), Box<Dim>::empty(),
      [&](std::size_t e) { return box_around(mesh.points(static_cast<ElementId>(e))); },
      [](const Box<Dim>& a, const Box<Dim>& b) { return join(a, b); });
  std::vector<Keyed> keyed(mesh.corners_of.size());
  runtime::parallel_for(executor, keyed.size(), [&](std::size_t e) {
    const Box<Dim> box = box_around(mesh.points(static_cast<ElementId>(e)));
    keyed[e] = {hilbert_key(0.5 * (box.low + box.high), all), static_cast<ElementId>(e)};
  });
  runtime::parallel_sort(executor, std::span(keyed));
  order_.resize(keyed.size());
  boxes_of_.emplace_back(keyed.size());
  runtime::parallel_for(executor, keyed.size(), [&](std::size_t i) {
    order_[i] = keyed[i].element;
    boxes_of_[0][i] = box_around(mesh.points(keyed[i].element));
  });
  while (boxes_of_.back().size() > 1) {
    const std::vector<Box<Dim>>& below = boxes_of_.back();
    std::vector<Box<Dim>> boxes((below.size() + width - 1) / width, Box<Dim>::empty());
    runtime::parallel_for(executor, boxes.size(), [&](std::size_t i) {
      for (std::size_t k = i * width; k < std::min(below.size(), (i + 1) * width); ++k)
        boxes[i] = join(boxes[i], below[k]);
    });
    boxes_of_.push_back(std::move(boxes));
  }
}

/// Looks into the nearer boxes first, and not into those that are too far away.
template <int Dim>
void BoxTree<Dim>::look_into(std::size_t level, std::size_t index, const Vector<Dim>& point,
                             ClosestPoint<Dim>& best) const {
  if (level == 0) {
    auto found = closest_in<Dim>(mesh_.points(order_[index]), point);
    found.element = order_[index];
    if (found.squared_distance < best.squared_distance) best = found;
    return;
  }
  std::array<std::pair<double, std::size_t>, width> below;
  std::size_t count = 0;
  const auto& boxes = boxes_of_[level - 1];
  for (std::size_t k = index * width; k < std::min(boxes.size(), (index + 1) * width); ++k)
    below[count++] = {squared_distance(boxes[k], point), k};
  std::sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count && below[i].first < best.squared_distance; ++i)
    look_into(level - 1, below[i].second, point, best);
}

template <int Dim>
ClosestPoint<Dim> BoxTree<Dim>::closest(const Vector<Dim>& point) const {
  ClosestPoint<Dim> best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  look_into(boxes_of_.size() - 1, 0, point, best);
  if (best.element == none) {  // no distance is a number
    best.element = order_[0];
    best.weight[0] = 1;
  }
  return best;
}

template <int Dim>
std::size_t BoxTree<Dim>::bytes() const {
  std::size_t sum = order_.capacity() * sizeof(order_[0]);
  for (const auto& boxes : boxes_of_) sum += boxes.capacity() * sizeof(boxes[0]);
  return sum;
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace ductile::meshadapt
