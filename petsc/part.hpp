/// @file
/// Part: the part of a distributed mesh that one rank has. No element is in two parts; the vertices
/// on interfaces between parts are, and have the same number in each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::petsc {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::VertexId;

/// The reference of what has no label.
inline constexpr std::int32_t unlabelled = std::numeric_limits<std::int32_t>::min();

struct Part {
  /// References are values of labels. Facets, and edges of tetrahedra, are listed if they have one;
  /// those on interfaces between parts in all that have them.
  AnyMesh mesh;
  AnyField wanted;                      ///< the metric to adapt to, one symmetric tensor a vertex
  std::vector<std::int64_t> number_of;  ///< [vertex], the same on all ranks
  std::vector<std::uint8_t> is_held;    ///< [vertex], 1 of those that the last pass held

  std::size_t element_count() const {
    return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  }
};

/// An empty part, as that of a rank to which nothing was given.
inline Part empty_part(int dimension) {
  Part part;
  part.mesh.dimension = part.wanted.dimension = dimension;
  part.wanted.types = {AnyField::Type::symmetric};
  return part;
}

}  // namespace ductile::petsc
