/// @file
/// Meshes to test with: grids with holes and regions over the unit square and cube, and ways to
/// make them harder: moved vertices, slivers, other places, sizes and directions in space.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt::test {

using Random = std::mt19937_64;
double uniform(Random& random, double low, double high);
bool chance(Random& random, double probability);
std::size_t below(Random& random, std::size_t limit);

using Cell = std::array<int, 3>;

struct Grid {
  int dimension = 2;
  std::array<std::vector<double>, 3> lines;  ///< [axis], ascending
  std::function<int(const Cell&)> region;    ///< reference of a cell's elements, 0: no cell there
  std::uint64_t seed = 0;  ///< 2D: for random directions of diagonals; 0: all equal
};

/// n equal cells along each axis of the unit square or cube, one region.
Grid unit_grid(int dimension, int n);

/// Cuts the cells into 2 triangles or 6 tetrahedra (Kuhn), lists boundary facets and, by default,
/// interfaces. A facet's reference is the direction it faces: 1 to 6 for -x +x -y +y -z +z, plus 10
/// on interfaces. No vertex is unused.
AnyMesh make_grid(const Grid& grid, bool list_interfaces = true);

/// Shapes, by the region of a cell of an n x n (x n) grid; see Grid::region.
int whole(const Cell& cell);
std::function<int(const Cell&)> l_shape(int n);
std::function<int(const Cell&)> with_hole(int n);   ///< a cavity in 3D
std::function<int(const Cell&)> two_halves(int n);  ///< two regions that share a plane
std::function<int(const Cell&)> checkerboard();     ///< two regions
std::function<int(const Cell&)> random_regions(std::uint64_t seed, int count, bool holes);

/// The other facets, edges and corners of a mesh.
template <int Dim>
using FacetElements = std::map<Facet<Dim>, std::vector<ElementId>>;  // sorted corners -> elements
template <int Dim>
const Cells<Dim + 1>& elements(const AnyMesh& mesh);
template <int Dim>
const Cells<Dim>& facets(const AnyMesh& mesh);
template <int Dim>
FacetElements<Dim> facet_elements(const AnyMesh& mesh);
template <int Dim>
Vector<Dim> point(const AnyMesh& mesh, std::uint32_t vertex);

/// Lists the edges of a 3D mesh between listed facets of different references as ridges with
/// references of their own, and the vertices where several references of them meet as corners.
void list_ridges(AnyMesh& mesh);

/// Moves each vertex that lies inside a region by up to `amount` times the extent of its
/// surroundings, unless that would invert an element.
void jiggle(AnyMesh& mesh, Random& random, double amount);

/// Moves `count` inner vertices almost onto a facet of an element around them; the distance shrinks
/// by the factor `thickness`. Every element keeps an exactly positive volume.
void make_slivers(AnyMesh& mesh, Random& random, std::size_t count, double thickness);

/// Bends the unit square or cube into an arc around the origin, starting at the x axis: x becomes
/// the radius, from 0.5 to 1.5, and y the angle, from 0 to `angle`. References stay: 1 is the
/// inside of the arc, 2 the outside, 3 and 4 its ends.
void bend(AnyMesh& mesh, double angle);

/// A truncated cone of height 1 with n cells along each axis; its base has radius 1, its lid radius
/// `lid`. The mantle has reference 1, the base 5, the lid 6.
AnyMesh truncated_cone(int n, double lid);

/// Turns the mesh by a random rotation, scales it and moves it.
void place(AnyMesh& mesh, Random& random, double scale, double offset);

}  // namespace ductile::meshadapt::test
