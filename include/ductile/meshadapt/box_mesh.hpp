/// @file
/// Meshes to start from: a rectangle or a box, from the origin on, cut into equal cells and those
/// into triangles or tetrahedra. Their boundaries are listed; references tell the sides apart, and
/// adaptation keeps them, so boundary conditions can be found by them.
#pragma once

#include <array>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// References of boundary edges in 2D, of boundary triangles in 3D. Left is x = 0, bottom y = 0,
/// front z = 0; right, top and back are opposite.
struct Side {
  static constexpr int left = 1, right = 2, bottom = 3, top = 4, front = 5, back = 6;
};

/// Two triangles a cell, with diagonals that alternate. `extent` along x and y, `cells` along each.
/// Throws InputError unless extents are positive and there is a cell along each axis.
/// Elements have reference 1. Thread safety: any thread.
AnyMesh rectangle_mesh(const std::array<double, 2>& extent, const std::array<int, 2>& cells);

/// Six tetrahedra a cell (Kuhn). Throws as above. Thread safety: any thread.
AnyMesh box_mesh(const std::array<double, 3>& extent, const std::array<int, 3>& cells);

}  // namespace ductile::meshadapt
