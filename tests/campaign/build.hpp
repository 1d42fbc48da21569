/// @file
/// What meshes of random bodies are made with: grids, of which cells are left out; cuts, at which
/// vertices are doubled; voids; maps of space. All keep elements positive, or say that they cannot.
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
  std::array<std::vector<double>, 3> lines;  ///< where grid lines cross each axis, ascending
  bool closed = false;                       ///< along the first axis: its last line is its first
  /// Which cells are there, by their index along each axis; all if none is given.
  std::function<bool(const std::array<int, 3>&)> keep;
};

/// `count` cells from 0 to `length`.
std::vector<double> even_lines(int count, double length = 1);

/// Triangles or tetrahedra of all cells that are kept; diagonals are random in 2D.
Mesh make_grid(Random& random, const Grid& grid);

/// Leaves out elements whose centre does not fulfil `keep`, and vertices that no element has.
void keep_elements(Mesh& mesh, const std::function<bool(const Point&)>& keep);

/// Takes elements away until the boundary meets itself nowhere, and all but the largest part.
void remove_non_manifold(Mesh& mesh);

/// Doubles vertices so that the facets between elements that fulfil `is_cut` become boundary on
/// both sides, apart everywhere but at their rim. Returns, for each vertex, which it was.
std::vector<int> cut(Mesh& mesh, const std::function<bool(const std::vector<Point>&)>& is_cut);

/// Takes a part of one tetrahedron out, which is like the whole and `share` times as long, so that
/// its facets stay apart from those of the tetrahedron. With `random`, its corners are then put at
/// random places in the tetrahedron.
void hollow(Mesh& mesh, std::size_t element, double share, Random* random = nullptr);

/// Puts a vertex at `share` of the edge from a to b, in all elements that have the edge.
void split_edge(Mesh& mesh, const std::array<int, 2>& edge, double share);

struct Jitter {
  double amount = 0;  ///< of the shortest edge of each vertex
  /// Vertices of the boundary from this one on move as well.
  std::size_t boundary_from = SIZE_MAX;
};

/// Moves inner vertices at random, unless that would turn an element.
void jitter(Random& random, Mesh& mesh, const Jitter& how);

/// Moves all vertices; false, and the mesh as it was, if an element would not be positive.
bool map(Mesh& mesh, const std::function<Point(const Point&)>& to);

bool all_positive(const Mesh& mesh);

/// Lists the boundary and, if asked for, interfaces between elements of different reference. The
/// reference of a facet is what `reference` says of its centre and normal.
void list_facets(Mesh& mesh, bool interfaces,
                 const std::function<int(const Point&, const Point&)>& reference);

}  // namespace ductile::campaign
