/// @file
/// Camera: looks at a solid from far away, so that parallel lines stay parallel; and the plane
/// through the middle of a solid, and where it cuts elements.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "extents.hpp"

namespace ductile::cli {

struct Point {
  double x = 0, y = 0;  ///< to the right, upwards
};

/// Right, up and towards the viewer: three orthogonal unit vectors.
struct Camera {
  Position right, up, towards;

  Point project(const Position& p) const { return {dot(right, p), dot(up, p)}; }
  double depth(const Position& p) const { return dot(towards, p); }  ///< larger is nearer
};

/// A camera that looks mostly along this axis (0, 1, 2) and a little from the side and from above.
Camera camera_along(int axis);

/// The axis along which a solid is thinnest; front to back if it is about as thick everywhere.
int thinnest_axis(const AnyMesh& mesh);

/// The plane where coordinate `axis` is `at`.
struct CutPlane {
  int axis = 0;
  double at = 0;
  double outwards = 1;  ///< towards the viewer: 1 or -1 along the axis

  /// The distance of a point from the plane, positive towards the viewer.
  double side(const Position& p) const { return outwards * (p[axis] - at); }
};
CutPlane middle_plane(const AnyMesh& mesh, const Camera& camera, int axis);

using Tetrahedron = std::array<Position, 4>;
Tetrahedron tetrahedron(const AnyMesh& mesh, std::size_t element);

/// The section of a tetrahedron: empty, a triangle or a quadrangle.
std::vector<Position> section(const Tetrahedron& corner, const CutPlane& plane);

}  // namespace ductile::cli
