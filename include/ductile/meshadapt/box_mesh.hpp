/// @file
/// Meshes to start from: a rectangle or a box from the origin on, cut into equal cells and those
/// into triangles or tetrahedra. And whether a mesh still fills the unit one.
#pragma once

#include <array>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::bench {

/// References of the sides: of boundary edges in 2D, of boundary triangles in 3D.
enum Side : int { left = 1, right = 2, bottom = 3, top = 4, front = 5, back = 6 };

/// Two triangles a cell, with diagonals that alternate. x runs from left to right, y from bottom
/// to top.
meshadapt::AnyMesh rectangle_mesh(const std::array<double, 2>& extent,
                                  const std::array<int, 2>& cells);

/// Six tetrahedra a cell (Kuhn). z runs from front to back.
meshadapt::AnyMesh box_mesh(const std::array<double, 3>& extent, const std::array<int, 3>& cells);

/// Whether the elements of a mesh lie in the unit square or cube and have its measure, to 1e-9. A
/// valid mesh may fail to: check_mesh knows nothing of the domain.
bool fills_unit_box(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::bench
