/// @file
/// Camera: looks at a solid from far away, so that parallel lines stay parallel.
#pragma once

#include "ductile/meshadapt/simplex.hpp"

namespace ductile::cli {

struct Point {
  double x = 0, y = 0;  ///< to the right, upwards
};

using Position = meshadapt::Vector<3>;

/// Right, up and towards the viewer: three orthogonal unit vectors.
struct Camera {
  Position right, up, towards;

  Point project(const Position& p) const { return {dot(right, p), dot(up, p)}; }
  double depth(const Position& p) const { return dot(towards, p); }  ///< larger is nearer
};

/// A camera that looks mostly along this axis (0, 1, 2) and a little from the side and from above.
Camera camera_along(int axis);

}  // namespace ductile::cli
