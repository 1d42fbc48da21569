/// @file
/// Locator: finds the place of a point in a mesh. Walks from a nearby element and, if that fails,
/// searches for the closest point of the mesh. On a surface alone, where every point counts as
/// inside, it always searches, and walks to tell sheets that are about as close from each other.
#pragma once

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/walk.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct Place {
  ElementId element;
  Weights<Dim> weight;  // none below 0, sum 1
  bool inside;          // false: the place is the closest point of the mesh
};

template <int Dim, int Space = Dim>
class Locator {
 public:
  /// Refers to the mesh.
  Locator(const runtime::Executor& executor, const FixedMesh<Dim, Space>& mesh)
      : mesh_(mesh), tree_(executor, {mesh.corners_of, mesh.position_of}) {}

  /// Finds a point, starting from element `near` (or none); on a surface, on the sheet of that one
  /// if another is hardly closer. Thread safety: any thread.
  Place<Dim> find(const Vector<Space>& point, ElementId near) const {
    if constexpr (Dim < Space) return on_surface(point, near);
    if (near == none) near = tree_.closest(point).element;
    const Walkable<Dim, Space> view{{mesh_.corners_of, mesh_.position_of}, mesh_.neighbour_of};
    WalkEnd<Dim> end = walk(view, point, near);
    if (!end.inside) return closest(point);
    double sum = 0;
    for (double& w : end.weight) sum += w = std::max(w, 0.0);
    for (double& w : end.weight) w /= sum;
    return {end.element, end.weight, true};
  }

  const FixedMesh<Dim, Space>& mesh() const { return mesh_; }

 private:
  Place<Dim> on_surface(const Vector<Space>& point, ElementId near) const {
    constexpr double as_close = 4;  // squared
    const ClosestPoint<Dim> closest = tree_.closest(point);
    if (near == none) return {closest.element, closest.weight, true};
    const Simplices<Dim, Space> elements{mesh_.corners_of, mesh_.position_of};
    WalkEnd<Dim> end = walk(Walkable<Dim, Space>{elements, mesh_.neighbour_of}, point, near);
    double sum = 0;
    for (double& w : end.weight) sum += w = std::max(w, 0.0);
    Vector<Space> there;
    const auto corners = elements.points(end.element);
    for (std::size_t i = 0; i <= Dim; ++i) there += (end.weight[i] /= sum) * corners[i];
    const double rounding = 1e-18 * mesh_.volume_of[end.element];
    if (dot(there - point, there - point) <= as_close * closest.squared_distance + rounding)
      return {end.element, end.weight, true};
    return {closest.element, closest.weight, true};
  }

  /// A point outside by no more than rounding, relative to the element's size, counts as inside.
  Place<Dim> closest(const Vector<Space>& point) const {
    constexpr double tolerance = 1e-9;
    const ClosestPoint<Dim> found = tree_.closest(point);
    const double size = std::pow(mesh_.volume_of[found.element], 1.0 / Dim);
    const bool inside = found.squared_distance <= tolerance * tolerance * size * size;
    return {found.element, found.weight, inside};
  }

  const FixedMesh<Dim, Space>& mesh_;
  BoxTree<Dim, Space> tree_;
};

template <int Dim, int Space>
Vector<Space> centroid_of(const FixedMesh<Dim, Space>& mesh, ElementId element) {
  Vector<Space> centroid;
  for (const Vector<Space>& corner : mesh.points(element)) centroid += (1.0 / (Dim + 1)) * corner;
  return centroid;
}

/// Finds points one after another in fixed blocks, so that walks are short and do not depend on
/// threads: find_next(i, near) returns the element of point i, given the previous one's, or none.
template <class FindNext>
void walk_in_blocks(const runtime::Executor& executor, std::size_t count, FindNext&& find_next) {
  constexpr std::size_t block_size = 256;
  runtime::parallel_for_blocks(executor, count, block_size,
                               [&](std::size_t, std::size_t begin, std::size_t end) {
                                 ElementId near = none;
                                 for (std::size_t i = begin; i < end; ++i)
                                   near = find_next(i, near);
                               });
}

}  // namespace ductile::meshadapt
