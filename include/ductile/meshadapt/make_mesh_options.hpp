/// @file
/// MakeMeshOptions: what of the boundary of a mesh is kept when it is adapted.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace ductile::meshadapt {

class Geometry;  // geometry.hpp

/// How a Mesh is made from that of a file: what of its boundary may change.
struct MakeMeshOptions {
  bool complete_boundary =
      false;                   ///< give unlisted boundary facets reference 0, do not refuse them
  bool lock_boundary = false;  ///< treat every boundary and interface facet as required
  /// Hausdorff tolerance: how far curved boundaries, interfaces and the curves between them may be
  /// from a smooth model of the input, a length; 0: they keep the facets they have.
  double hausdorff_tolerance = 0;
  /// Degrees, more than 0 and less than 90. Two facets whose normals differ by this angle or more
  /// meet in a ridge, two edges of a curve in a corner; both are kept. What turns by less is
  /// curved.
  double ridge_angle = 45;
  /// Where distances are measured from; null: from a model of this mesh. Wants a
  /// hausdorff_tolerance, which must be the geometry's.
  std::shared_ptr<const Geometry> geometry = nullptr;
  /// Vertices at which curved boundaries keep the facets they have all the same. Indices, from 0.
  std::vector<std::uint32_t> keep_facets_at = {};
};

}  // namespace ductile::meshadapt
