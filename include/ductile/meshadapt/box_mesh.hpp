/// @file
/// A mesh to start from: a box, in 2D a rectangle, from the origin on, cut into equal cells and
/// those into triangles or tetrahedra. Its boundary is listed; references tell the sides apart, and
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

/// In 2D two triangles a cell, with diagonals that alternate; in 3D six tetrahedra a cell (Kuhn).
/// `extent` and `cells` are along each axis. Throws InputError unless extents are positive, there
/// is a cell along each axis, and 32 bits can count the vertices. Elements have reference 1.
/// Thread safety: any thread.
template <int Dim = 3>
AnyMesh box_mesh(const std::array<double, Dim>& extent, const std::array<int, Dim>& cells);

template <>
AnyMesh box_mesh<2>(const std::array<double, 2>& extent, const std::array<int, 2>& cells);
template <>
AnyMesh box_mesh<3>(const std::array<double, 3>& extent, const std::array<int, 3>& cells);

}  // namespace ductile::meshadapt
