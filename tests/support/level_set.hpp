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

double sphere_level(const Vector<3>& p);  ///< of radius 1; the distance to it
double torus_level(const Vector<3>& p);   ///< around the z axis, radii 1 and 0.4; the distance
double gyroid_level(const Vector<3>& p);  ///< a sheet of some thickness, of period 1
double cube_level(const Vector<3>& p);    ///< from -1 to 1, with sharp edges
double plate_level(const Vector<3>& p);   ///< of radius 1 and thickness 0.02, rounded at its rim

/// n^3 cells of six tetrahedra over a cube from -extent to extent, rotated, and shifted by less
/// than a cell.
struct LevelGrid {
  int n = 10;
  double extent = 1.4;
  std::uint64_t seed = 0;  ///< of how it is turned and moved, and of the noise; 0: it is not moved
  double least = 0;        ///< of an edge, closer to whose ends no zero is put, wherever it is
  double noise = 0;        ///< of an edge, by which zeros are off at random
};

/// Returns the tetrahedra inside. Triangles at the zero have reference 1, those on the grid's
/// boundary 2. Where a tetrahedron would be inverted, zeros lie where the function's linear
/// interpolant along edges has them.
AnyMesh cut_out(const LevelGrid& grid, const Level& level);

}  // namespace ductile::meshadapt::test
