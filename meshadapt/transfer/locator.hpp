/// @file
/// Locator<Dim>: finds the place of a point in a mesh. Walks from a nearby element and, if that
/// fails, searches for the closest point of the mesh.
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

template <int Dim>
class Locator {
 public:
  /// Refers to the mesh.
  Locator(const runtime::Executor& executor, const FixedMesh<Dim>& mesh)
      : mesh_(mesh), tree_(executor, {mesh.corners_of, mesh.position_of}) {}

  /// Finds a point, starting from element `near` (or none). Thread safety: any thread.
  Place<Dim> find(const Vector<Dim>& point, ElementId near) const {
    if (near == none) near = tree_.closest(point).element;
    const Walkable<Dim> view{{mesh_.corners_of, mesh_.position_of}, mesh_.neighbour_of};
    WalkEnd<Dim> end = walk(view, point, near);
    if (!end.inside) return closest(point);
    double sum = 0;
    for (double& w : end.weight) sum += w = std::max(w, 0.0);
    for (double& w : end.weight) w /= sum;
    return {end.element, end.weight, true};
  }

  const FixedMesh<Dim>& mesh() const { return mesh_; }

 private:
  /// A point outside by no more than rounding, relative to the element's size, counts as inside.
  Place<Dim> closest(const Vector<Dim>& point) const {
    constexpr double tolerance = 1e-9;
    const ClosestPoint<Dim> found = tree_.closest(point);
    const double size = std::pow(mesh_.volume_of[found.element], 1.0 / Dim);
    const bool inside = found.squared_distance <= tolerance * tolerance * size * size;
    return {found.element, found.weight, inside};
  }

  const FixedMesh<Dim>& mesh_;
  BoxTree<Dim> tree_;
};

template <int Dim>
Vector<Dim> centroid_of(const FixedMesh<Dim>& mesh, ElementId element) {
  Vector<Dim> centroid;
  for (const Vector<Dim>& corner : mesh.points(element)) centroid += (1.0 / (Dim + 1)) * corner;
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
