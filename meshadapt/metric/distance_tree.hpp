/// @file
/// DistanceTree: how far points are from the nearest of many points, segments and triangles, by a
/// tree of boxes around them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/box_hierarchy.hpp"

namespace ductile::meshadapt {

/// A point, a segment or a triangle; corners beyond their number are copies of the first.
struct Piece {
  std::array<Vector<3>, 3> corner;
  std::size_t corners = 1;
};

class DistanceTree {
 public:
  /// Throws std::bad_alloc.
  DistanceTree(const runtime::Executor& executor, const std::vector<Piece>& pieces);

  /// The distance to the nearest piece, or `most` if none is closer than that. Thread safety: any
  /// thread.
  double distance(const Vector<3>& point, double most) const;

 private:
  BoxHierarchy<3> boxes_;
  std::vector<Piece> pieces_;  // as they are in the order of their boxes
};

}  // namespace ductile::meshadapt
