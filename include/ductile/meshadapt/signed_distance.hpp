/// @file
/// signed_distance: the distance to the smooth surface between regions of a mesh, for level sets
/// that are moved step by step and cut anew.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

struct SignedDistanceOptions {
  std::vector<std::int32_t> inside;  ///< references of elements where the distance is negative
  /// Largest distance of the smooth surface from the facets; 0: a tenth of their mean edge length.
  double tolerance = 0;
  double ridge_angle = 45;  ///< as MakeMeshOptions::ridge_angle
};

/// The distance to the interface: the facets between elements inside and others, curved through
/// their vertices as adapt() does with a Hausdorff tolerance, so that round interfaces do not
/// shrink in a loop of cuts. The domain's boundary is not part of it. Without `points`
/// [vertex]: exactly 0 on the interface, elsewhere with the sign of the elements around the vertex.
/// With them, coordinates[point * dimension + axis], [point]: with the sign of the element that
/// contains the point or is the closest to it, except close to the interface, where the curved
/// surface counts. Throws InputError if the mesh is not valid, an option is out of range, or no
/// facet lies between elements inside and others. The result does not depend on the number of
/// threads. Thread safety: one caller; runs on the executor.
std::vector<double> signed_distance(const runtime::Executor& executor, const AnyMesh& mesh,
                                    const SignedDistanceOptions& options,
                                    std::span<const double> points = {});

}  // namespace ductile::meshadapt
