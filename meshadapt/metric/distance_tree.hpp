/// @file
/// DistanceTree: how far points are from the nearest of many points, segments and triangles, by a
/// tree of boxes around them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ductile/meshadapt/vector.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

/// A point, a segment or a triangle; corners beyond their number are copies of the first.
struct Piece {
  std::array<Vector<3>, 3> corner;
  std::size_t corners = 1;
};

class DistanceTree {
 public:
  /// Throws std::bad_alloc.
  DistanceTree(const runtime::Executor& executor, std::vector<Piece> pieces);

  /// The distance to the nearest piece, or `most` if none is closer than that. Thread safety: any
  /// thread.
  double distance(const Vector<3>& point, double most) const;

 private:
  void look_into(std::size_t level, std::size_t index, const Vector<3>& point,
                 double& square) const;

  std::vector<Piece> pieces_;                  // along a space-filling curve
  std::vector<std::vector<Box<3>>> boxes_of_;  // [level][index]: of `width` boxes a level below
};

}  // namespace ductile::meshadapt
