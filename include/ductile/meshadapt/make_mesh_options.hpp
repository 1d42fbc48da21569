/// @file
/// MakeMeshOptions: what of the boundary of a mesh is kept when it is adapted.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

namespace ductile::meshadapt {

class Geometry;  // geometry.hpp

struct MakeMeshOptions {
  bool complete_boundary =
      false;                   ///< give unlisted boundary facets reference 0, do not refuse them
  bool lock_boundary = false;  ///< treat every boundary and interface facet as required
  /// How far curved boundaries, interfaces and the curves between them may be from where they were,
  /// a length; 0: they keep the facets they have.
  double surface_tolerance = 0;
  /// Facets, or edges of a curve, that turn by as many degrees where they meet meet at a ridge, or
  /// a corner, which stays. Those that turn by less are curved. More than 0, less than 90.
  double ridge_angle = 45;
  /// What curved boundaries are like, if not what they are like in the mesh: distances are measured
  /// from it. With a surface_tolerance, which is the geometry's.
  std::shared_ptr<const Geometry> geometry = nullptr;
  /// Vertices at which curved boundaries keep the facets they have all the same. Indices, from 0.
  std::vector<std::uint32_t> keep_facets_at = {};
};

}  // namespace ductile::meshadapt
