/// @file
/// Fields carried from one mesh to another: by interpolation, or by a projection that keeps their
/// integral. All components of all fields are carried, each for itself; what is linear on the whole
/// old mesh arrives exactly. Metrics are better carried by adapt(), which interpolates logarithms.
/// Results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <span>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A field and the mesh that it lives on. It refers to both, so it is for passing them only.
struct FieldOnMesh {
  const AnyMesh& mesh;
  const AnyField& field;
};

/// How well the meshes cover each other. Volumes are areas in 2D.
struct TransferReport {
  std::size_t vertices_outside = 0;  ///< vertices of the new mesh that are not in the old one
  double volume_outside = 0;         ///< of the new mesh that is not in the old one
  double volume_left_out = 0;        ///< of the old mesh that is not in the new one
};

struct TransferredField {
  AnyField field;
  TransferReport report;  ///< of an interpolation, vertices only
};

/// The values that the old field, linear in each element, has at the new vertices. Keeps bounds,
/// not integrals. A vertex outside the old mesh gets the value at the point of it that is closest.
/// Throws InputError if a mesh is not valid (see make_fixed_mesh), a vertex of either is not within
/// -1e150 to 1e150, or the field is not of the old one. Thread safety: one caller; runs on the
/// executor.
TransferredField interpolate_field(const runtime::Executor& executor, const FieldOnMesh& from,
                                   const AnyMesh& to);

/// The same at points of one's own choice, one after another: coordinates[point * dimension +
/// axis]. The field that is returned has them in place of vertices, and so does the report. Throws
/// InputError as well if coordinates are not within -1e150 to 1e150 or do not come in whole points.
/// Thread safety: one caller; runs on the executor.
TransferredField interpolate_at(const runtime::Executor& executor, const FieldOnMesh& from,
                                std::span<const double> coordinates);

struct ProjectionOptions {
  /// No value above or below those of the old elements that touch the new elements around the
  /// vertex, so no overshoot at a front, and 0 to 1 stays 0 to 1. False: the L2 projection as it
  /// is, a little closer to the old field.
  bool keep_bounds = true;
};

/// The linear elements on the new mesh that are closest to the old field in L2, with the integrals
/// over old and new elements cut by each other taken exactly (supermesh projection: Farrell,
/// Piggott, Pain, Gorman & Wilson, Comput. Methods Appl. Mech. Eng. 198, 2009). Bounds are kept by
/// flux correction (Zalesak, J. Comput. Phys. 31, 1979) towards the lumped projection. Where both
/// meshes cover the same domain, the integral of each component is kept to rounding, with or
/// without bounds. Where the new mesh reaches beyond the old one, as on curved boundaries, the
/// interpolated field counts there, and what lies beyond the new mesh is lost: the report says how
/// much volume that concerns. Throws as above, and if a value is not finite, as it would spread.
/// Thread safety: one caller; runs on the executor.
TransferredField project_field(const runtime::Executor& executor, const FieldOnMesh& from,
                               const AnyMesh& to, const ProjectionOptions& options = {});

}  // namespace ductile::meshadapt
