/// @file
/// cell_shapes: the shapes of cells as VTK and Gmsh number them. Any thread.
#pragma once

#include <array>
#include <cstdint>

namespace ductile::meshadapt {

struct CellShape {
  int vtk, gmsh;  ///< types; 0: the format has no such shape
  int corners;    ///< of simplices of first order; 0: the shape is not read
  const char* name;
};

inline constexpr std::array<CellShape, 20> cell_shapes{
    {{1, 15, 1, "a point"},
     {3, 1, 2, "a line"},
     {5, 2, 3, "a triangle"},
     {10, 4, 4, "a tetrahedron"},
     {9, 3, 0, "a quadrangle"},
     {12, 5, 0, "a hexahedron"},
     {13, 6, 0, "a prism"},
     {14, 7, 0, "a pyramid"},
     {21, 8, 0, "a line of second order"},
     {22, 9, 0, "a triangle of second order"},
     {28, 10, 0, "a quadrangle of second order"},
     {24, 11, 0, "a tetrahedron of second order"},
     {29, 12, 0, "a hexahedron of second order"},
     {32, 13, 0, "a prism of second order"},
     {27, 14, 0, "a pyramid of second order"},
     {23, 16, 0, "a quadrangle of second order"},
     {25, 17, 0, "a hexahedron of second order"},
     {6, 0, 0, "a triangle strip"},
     {7, 0, 0, "a polygon"},
     {42, 0, 0, "a polyhedron"}}};

/// The shape with this number, by `CellShape::vtk` or `CellShape::gmsh`; without corners and called
/// "another cell" if there is none.
inline CellShape shape_of(int CellShape::*number, std::int64_t type) {
  for (const CellShape& shape : cell_shapes)
    if (shape.*number == type && type != 0) return shape;
  return {0, 0, 0, "another cell"};
}

}  // namespace ductile::meshadapt
