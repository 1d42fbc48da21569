#include "mesh/box_tree.hpp"

#include <algorithm>
#include <limits>

#include "core/small_system.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The point closest to the origin in the affine span of the chosen corners: weights that sum to 1
/// and may be negative. False if the corners are degenerate.
template <int Dim, int Space>
bool closest_in_span(const std::array<Vector<Space>, Dim + 1>& corner, unsigned chosen,
                     Weights<Dim>& weight) {
  std::size_t base = 0;
  while ((chosen >> base & 1U) == 0) ++base;
  SmallSystem<Dim> system;
  const auto moves = [&](std::size_t unknown) {
    return unknown + 1 > base && (chosen >> (unknown + 1) & 1U) != 0;
  };
  for (std::size_t axis = 0; axis < Space; ++axis) {
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
template <int Dim, int Space>
ClosestPoint<Dim> closest_in(std::array<Vector<Space>, Dim + 1> corner,
                             const Vector<Space>& point) {
  ClosestPoint<Dim> best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (Vector<Space>& p : corner) p -= point;
  for (unsigned chosen = 1; chosen < 1U << (Dim + 1); ++chosen) {
    Weights<Dim> weight;
    if (!closest_in_span<Dim, Space>(corner, chosen, weight)) continue;
    if (*std::min_element(weight.begin(), weight.end()) < 0) continue;
    Vector<Space> at;
    for (std::size_t i = 0; i <= Dim; ++i) at += weight[i] * corner[i];
    if (dot(at, at) >= best.squared_distance) continue;
    best.weight = weight;
    best.squared_distance = dot(at, at);
  }
  return best;
}

}  // namespace

template <int Dim, int Space>
BoxTree<Dim, Space>::BoxTree(const Executor& executor, const Simplices<Dim, Space>& mesh)
    : mesh_(mesh), boxes_(executor, mesh.corners_of.size(), [&](std::size_t e) {
        return box_around(mesh.points(static_cast<ElementId>(e)));
      }) {}

template <int Dim, int Space>
ClosestPoint<Dim> BoxTree<Dim, Space>::closest(const Vector<Space>& point) const {
  ClosestPoint<Dim> best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  boxes_.visit_near(point, best.squared_distance, [&](std::size_t place) {
    const ElementId element = boxes_.order()[place];
    auto found = closest_in<Dim, Space>(mesh_.points(element), point);
    found.element = element;
    if (found.squared_distance < best.squared_distance) best = found;
  });
  if (best.element == none) {  // no distance is a number
    best.element = boxes_.order()[0];
    best.weight[0] = 1;
  }
  return best;
}

template class BoxTree<2>;
template class BoxTree<2, 3>;
template class BoxTree<3>;

}  // namespace ductile::meshadapt
