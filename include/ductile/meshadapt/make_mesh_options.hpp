/// @file
/// MakeMeshOptions: what of the boundary of a mesh is kept when it is adapted.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace ductile::meshadapt {

class Geometry;  // geometry.hpp

/// What all facets of a reference truly lie on, as a CAD kernel knows it.
struct SurfaceFunction {
  std::int32_t reference = 0;  ///< of facets, edges in 2D
  /// The closest point of the surface to a point that is near it; z is 0 in 2D, and does not count
  /// in the result. It may go on beyond its ridges: a cylinder need not end. Must be the same
  /// whenever it is asked, and its own result up to rounding if it is asked for that. Called by
  /// several threads at a time. What it throws comes out of the call that it was needed for.
  std::function<std::array<double, 3>(const std::array<double, 3>&)> closest;
};

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
  /// Surfaces that are known by functions: new and moved vertices of curved boundaries lie on them,
  /// and not on the model. Not with a geometry, which has its own.
  std::vector<SurfaceFunction> functions = {};
  /// Vertices at which curved boundaries keep the facets they have all the same. Indices, from 0.
  std::vector<std::uint32_t> keep_facets_at = {};
};

}  // namespace ductile::meshadapt
