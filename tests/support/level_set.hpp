/// @file
/// level_set: the tetrahedra below the zero of a function, cut out of a grid by marching
/// tetrahedra, so that many facets are needles and slivers at large angles to their neighbours.
#pragma once

#include <cstdint>
#include <functional>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::meshadapt::test {

/// A continuous function that is negative inside.
using Level = std::function<double(const Vector<3>&)>;

double sphere_level(const Vector<3>& p);  ///< distance from a sphere of radius 1
double torus_level(const Vector<3>& p);   ///< distance from a torus around z, radii 1 and 0.4
double gyroid_level(const Vector<3>& p);  ///< a gyroid sheet of some thickness, with period 1
double cube_level(const Vector<3>& p);    ///< a cube from -1 to 1, with sharp edges
double plate_level(const Vector<3>& p);   ///< a disc of radius 1, thickness 0.02, with a round rim

/// n^3 cells of six tetrahedra over a cube from -extent to extent, rotated, and shifted by less
/// than a cell.
struct LevelGrid {
  int n = 10;
  double extent = 1.4;
  std::uint64_t seed = 0;  ///< for rotation, shift and noise; 0: the grid is not moved
  double least = 0;  ///< least distance of a zero from the ends of its edge, as a share of the edge
  double noise = 0;  ///< amplitude of random errors of zeros, as a share of the edge
};

/// Returns the tetrahedra inside. Triangles at the zero have reference 1, those on the grid's
/// boundary 2. Where a tetrahedron would be inverted, zeros lie where the function's linear
/// interpolant along edges has them.
AnyMesh cut_out(const LevelGrid& grid, const Level& level);

}  // namespace ductile::meshadapt::test
