/// @file
/// BoxTree<Dim>: finds the closest point of a mesh by a tree of boxes around its elements, where a
/// walk fails: for points outside, or behind a hole.
#pragma once

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/box_hierarchy.hpp"
#include "mesh/walk.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct ClosestPoint {
  ElementId element = none;
  Weights<Dim> weight{};  // barycentric weights of the point, none below 0
  double squared_distance = 0;
};

template <int Dim, int Space = Dim>
class BoxTree {
 public:
  /// Refers to the arrays of `mesh`. Throws std::bad_alloc.
  BoxTree(const runtime::Executor& executor, const Simplices<Dim, Space>& mesh);

  /// Finds the closest point of the mesh. Thread safety: any thread.
  ClosestPoint<Dim> closest(const Vector<Space>& point) const;

  std::size_t bytes() const { return boxes_.bytes(); }

 private:
  Simplices<Dim, Space> mesh_;
  BoxHierarchy<Space> boxes_;  // of elements
};

extern template class BoxTree<2>;
extern template class BoxTree<2, 3>;
extern template class BoxTree<3>;

}  // namespace ductile::meshadapt
