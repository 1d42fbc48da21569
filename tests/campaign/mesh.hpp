/// @file
/// Meshes and fields of the campaign as plain arrays, of a dimension known at run time. No file of
/// this folder includes a header of the library, so that a fault there cannot hide here.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace ductile::campaign {

using Point = std::array<double, 3>;  ///< in 2D the last coordinate is 0
using Cell = std::array<int, 4>;      ///< corners; those that a shape lacks are -1

/// Cells of one shape: edges, triangles or tetrahedra.
struct Cells {
  std::vector<Cell> corners;
  std::vector<int> reference;

  std::size_t size() const { return corners.size(); }
  void add(const Cell& cell, int ref) {
    corners.push_back(cell);
    reference.push_back(ref);
  }
};

struct Mesh {
  int dimension = 2;     ///< of space
  bool surface = false;  ///< triangles in space without tetrahedra: its facets are edges
  std::vector<Point> points;
  std::vector<int> point_reference;  ///< [point]
  std::map<int, Cells> cells;        ///< by number of corners: 2, 3, 4
  /// Sections that list indices: Corners, RequiredVertices, Ridges, RequiredEdges, ...
  std::map<std::string, std::vector<int>> lists;

  int element_dimension() const { return surface ? 2 : dimension; }
  int corner_count() const { return element_dimension() + 1; }  ///< of an element
  Cells& elements() { return cells[corner_count()]; }
  Cells& facets() { return cells[element_dimension()]; }
  const Cells& elements() const { return cells_of(corner_count()); }
  const Cells& facets() const { return cells_of(element_dimension()); }
  const Cells& cells_of(int corners) const {
    static const Cells none;
    const auto found = cells.find(corners);
    return found == cells.end() ? none : found->second;
  }
  const std::vector<int>& list(const std::string& name) const {
    static const std::vector<int> none;
    const auto found = lists.find(name);
    return found == lists.end() ? none : found->second;
  }
};

/// One field at the points: a size (1 component) or a symmetric tensor (3 in 2D, 6 in 3D), in the
/// order of the format: xx xy yy, in 3D xx xy yy xz yz zz.
struct Field {
  int dimension = 2;
  int components = 1;
  std::vector<double> values;  ///< [point * components + component]

  std::size_t size() const { return values.size() / static_cast<std::size_t>(components); }
};

}  // namespace ductile::campaign
