/// @file
/// Geometry: what the curved boundaries of a domain are like, kept while meshes of it come and go.
/// It is made once, from the first mesh or a finer one, and passed to every adapt(): distances are
/// then measured from it, not from the mesh that comes in, so that what is round stays so however
/// often it is adapted.
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

/// Its patches and curves; see geometry/reference_surface.hpp.
template <int Dim>
struct ReferenceSurface;

/// How a Geometry is made of a mesh.
struct GeometryOptions {
  /// How far facets of adapted meshes may be from the geometry, a length above 0; that of
  /// MakeMeshOptions::hausdorff_tolerance wherever the geometry is used.
  double tolerance = 0;
  double ridge_angle = 45;                      ///< as MakeMeshOptions::ridge_angle
  bool complete_boundary = false;               ///< as MakeMeshOptions::complete_boundary
  std::vector<SurfaceFunction> functions = {};  ///< as MakeMeshOptions::functions
  /// The meshes that are adapted with it are parts of its domain: they may have none of its curved
  /// boundaries. Otherwise a mesh without any is refused as one of another domain. It may be made
  /// of those elements only that touch listed facets and edges: facets of one element that are not
  /// listed are where these were cut from the others then, unless complete_boundary lists them.
  bool in_parts = false;
};

/// A point of a geometry.
struct GeometryPoint {
  std::array<double, 3> position;  ///< z is 0 in 2D
  std::array<double, 3> normal;    ///< unit length; outwards, where not on an interface
  std::int32_t reference;          ///< of the facet there
};

/// Copies share what they hold. Thread safety: any thread.
class Geometry {
 public:
  /// The boundary and interfaces of a mesh, as a smooth model of them: facets that turn by less
  /// than the ridge angle are parts of one smooth surface. Throws InputError if the mesh is not
  /// valid or an option is out of range, std::bad_alloc. Runs on the executor.
  Geometry(const runtime::Executor& executor, const AnyMesh& mesh, const GeometryOptions& options);

  int dimension() const { return plane_ ? 2 : 3; }
  double tolerance() const { return tolerance_; }

  /// The closest point within a distance, nearly: where the surface is curved, of its model near
  /// the closest point of flat parts that are within an eighth of the tolerance of it. Nothing if
  /// there is none, or if nothing is curved. z does not count in 2D. A logarithm of the size.
  std::optional<GeometryPoint> closest(const std::array<double, 3>& point, double reach) const;

  /// For adapt(). Null if nothing is curved, or the dimension is another.
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

/// The metric made finer at curved boundaries, as adapt() does by itself with a gradation or
/// curved_sizes, and kept within the bounds on sizes; nothing grows from there yet. For meshes that
/// are adapted in parts. Throws as adapt() does. Thread safety: any thread; runs on the executor.
AnyField bound_at_curved_boundaries(const runtime::Executor& executor, const AnyMesh& mesh,
                                    const AnyField& metric, const AdaptOptions& options);

}  // namespace ductile::meshadapt
