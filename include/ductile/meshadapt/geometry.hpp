/// @file
/// Geometry: the curved boundaries of a domain, independent of its meshes. It is made once, from
/// the first mesh or a finer one, and passed to every adapt(): distances are then measured from it,
/// not from the input mesh, so that round boundaries stay round however often they are adapted.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Patches and curves of a geometry; see geometry/reference_surface.hpp.
template <int Dim>
struct ReferenceSurface;

/// How a Geometry is made from a mesh.
struct GeometryOptions {
  /// Largest distance of facets of adapted meshes from the geometry, a length above 0;
  /// MakeMeshOptions::hausdorff_tolerance must equal it wherever the geometry is used.
  double tolerance = 0;
  double ridge_angle = 45;                      ///< as MakeMeshOptions::ridge_angle
  bool complete_boundary = false;               ///< as MakeMeshOptions::complete_boundary
  std::vector<SurfaceFunction> functions = {};  ///< as MakeMeshOptions::functions
  /// Adapted meshes are parts of its domain and may have none of its curved boundaries. Otherwise a
  /// mesh without any is refused as being of another domain. The geometry may then be made from
  /// only the elements that touch listed facets and edges: unlisted facets of one element count as
  /// cuts between parts, unless complete_boundary lists them.
  bool in_parts = false;
};

/// A point of a geometry.
struct GeometryPoint {
  std::array<double, 3> position;  ///< z is 0 in 2D
  std::array<double, 3> normal;    ///< unit length; outwards, except on an interface
  std::int32_t reference;          ///< of the facet there
};

/// A smooth model of curved boundaries. Copies share their data. Thread safety: any thread.
class Geometry {
 public:
  /// Makes a smooth model of the boundary and interfaces of a mesh, or of a surface alone: facets
  /// that meet at less than the ridge angle are parts of one smooth surface. Throws InputError if
  /// the mesh is not valid or an option is out of range, std::bad_alloc. Runs on the executor.
  Geometry(const runtime::Executor& executor, const AnyMesh& mesh, const GeometryOptions& options);

  int dimension() const { return plane_ ? 2 : 3; }
  double tolerance() const { return tolerance_; }

  /// An approximation of the closest point within the distance `reach`: the model's point near the
  /// closest point of flat parts that approximate it to an eighth of the tolerance. None if there
  /// is none or nothing is curved. Ignores z in 2D. Takes logarithmic time.
  std::optional<GeometryPoint> closest(const std::array<double, 3>& point, double reach) const;

  /// For adapt(). Null if nothing is curved, or the dimension differs.
  template <int Dim>
  const ReferenceSurface<Dim>* surface() const;

 private:
  double tolerance_;
  std::shared_ptr<const ReferenceSurface<2>> plane_;  // null in 3D
  std::shared_ptr<const ReferenceSurface<3>> space_;  // null in 2D
};

template <>
inline const ReferenceSurface<2>* Geometry::surface() const {
  return plane_.get();
}
template <>
inline const ReferenceSurface<3>* Geometry::surface() const {
  return space_.get();
}

/// The metric refined at curved boundaries, as adapt() does with a gradation or curved_sizes, and
/// clamped to the bounds on sizes, but not yet graded. For meshes that are adapted in parts. Throws
/// as adapt() does. Thread safety: any thread; runs on the executor.
AnyField bound_at_curved_boundaries(const runtime::Executor& executor, const AnyMesh& mesh,
                                    const AnyField& metric, const AdaptOptions& options);

}  // namespace ductile::meshadapt
