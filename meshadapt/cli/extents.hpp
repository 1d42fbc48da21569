/// @file
/// Extents of a mesh as people ask for them: its box, the length, area or volume of what has one
/// reference, and the smallest and largest angle.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::cli {

struct Extents {
  std::array<double, 3> low{}, high{};  ///< the box; entries beyond the dimension are 0

  /// [dimension, reference] length of edges, area of triangles, volume of tetrahedra.
  std::map<std::pair<int, std::int32_t>, double> size_of;

  /// Degrees: in 2D between edges, in 3D between facets of an element (dihedral); 0 without any.
  double smallest_angle = 0, largest_angle = 0;

  /// The size of all of one dimension.
  double total(int dimension) const;
};

/// Sums are made in the order of the mesh. Expects cells to name existing vertices.
Extents extents_of(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::cli
