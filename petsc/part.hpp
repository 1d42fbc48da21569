/// @file
/// Part: the part of a distributed mesh on one rank. Each element is in one part; vertices on
/// interfaces are in several, with the same number in each.
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

/// The reference of entities without a label.
inline constexpr std::int32_t unlabelled = std::numeric_limits<std::int32_t>::min();

struct Part {
  /// References are values of labels. Facets, and edges of tetrahedra, are listed if they have one;
  /// those on interfaces in all parts that have them.
  AnyMesh mesh;
  AnyField wanted;                      ///< the target metric, one symmetric tensor per vertex
  std::vector<std::int64_t> number_of;  ///< [vertex], the same on all ranks
  std::vector<std::uint8_t> is_held;    ///< [vertex], 1 if the last pass held it

  std::size_t element_count() const {
    return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  }
};

/// An empty part, for a rank without elements.
inline Part empty_part(int dimension) {
  Part part;
  part.mesh.dimension = part.wanted.dimension = dimension;
  part.wanted.types = {AnyField::Type::symmetric};
  return part;
}

}  // namespace ductile::petsc
