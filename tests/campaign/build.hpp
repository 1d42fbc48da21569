/// @file
/// Builds meshes of random bodies: grids with missing cells, cuts at which vertices are doubled,
/// voids, maps of space. All keep elements positive, or report that they cannot.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh.hpp"
#include "random.hpp"

namespace ductile::campaign {

struct Grid {
  int dimension = 2;
  std::array<std::vector<double>, 3> lines;  ///< positions of grid lines on each axis, ascending
  bool closed = false;                       ///< the last line of the first axis is its first
  /// Decides which cells exist, by their index along each axis; if empty, all do.
  std::function<bool(const std::array<int, 3>&)> keep;
};

/// `count` cells from 0 to `length`.
std::vector<double> even_lines(int count, double length = 1);

/// Makes the triangles or tetrahedra of all kept cells; diagonals are random in 2D.
Mesh make_grid(Random& random, const Grid& grid);

/// Removes elements whose centre fails `keep`, and vertices that no element has.
void keep_elements(Mesh& mesh, const std::function<bool(const Point&)>& keep);

/// Removes elements until the boundary is manifold, and all parts except the largest.
void remove_non_manifold(Mesh& mesh);

/// Doubles vertices so that facets between elements that satisfy `is_cut` become boundary on both
/// sides, connected only at the rim. Returns the original of each vertex.
std::vector<int> cut(Mesh& mesh, const std::function<bool(const std::vector<Point>&)>& is_cut);

/// Cuts a hole into one tetrahedron: a copy scaled by `share`, whose facets stay apart from the
/// tetrahedron's. With `random`, its corners are then moved to random places in the tetrahedron.
void hollow(Mesh& mesh, std::size_t element, double share, Random* random = nullptr);

/// Splits the edge from a to b at `share` of its length, in all elements that have it.
void split_edge(Mesh& mesh, const std::array<int, 2>& edge, double share);

struct Jitter {
  double amount = 0;  ///< relative to the shortest edge of each vertex
  /// Vertices of the boundary from this number on move as well.
  std::size_t boundary_from = SIZE_MAX;
};

/// Moves interior vertices at random, unless that would invert an element.
void jitter(Random& random, Mesh& mesh, const Jitter& how);

/// Moves all vertices. If an element would not stay positive, returns false and restores the mesh.
bool map(Mesh& mesh, const std::function<Point(const Point&)>& to);

bool all_positive(const Mesh& mesh);

/// Lists the boundary and, if asked for, interfaces between elements of different references. A
/// facet's reference is reference(centre, normal).
void list_facets(Mesh& mesh, bool interfaces,
                 const std::function<int(const Point&, const Point&)>& reference);

/// Leaves of a body in 3D the listed facets for which keep() says so: a surface alone.
void make_surface(Mesh& mesh, const std::function<bool()>& keep);

}  // namespace ductile::campaign
