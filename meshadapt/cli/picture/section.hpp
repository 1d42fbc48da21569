/// @file
/// The plane through the middle of a solid, and where it cuts elements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "camera.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::cli {

/// The plane where coordinate `axis` is `at`.
struct CutPlane {
  int axis = 0;
  double at = 0;
  double outwards = 1;  ///< towards the viewer: 1 or -1 along the axis

  /// The distance of a point from the plane, positive towards the viewer.
  double side(const Position& p) const { return outwards * (p[axis] - at); }
};
CutPlane middle_plane(const meshadapt::AnyMesh& mesh, const Camera& camera, int axis);

using Tetrahedron = std::array<Position, 4>;
Tetrahedron tetrahedron(const meshadapt::AnyMesh& mesh, std::size_t element);

/// The section of a tetrahedron: empty, a triangle or a quadrangle.
std::vector<Position> section(const Tetrahedron& corner, const CutPlane& plane);

struct Span {
  double from = 0, to = 0;
};
Span span_along(const meshadapt::AnyMesh& mesh, int axis);

}  // namespace ductile::cli
