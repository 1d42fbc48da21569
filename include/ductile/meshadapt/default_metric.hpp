/// @file
/// The metrics to adapt to when the user has none: one size everywhere, or the sizes that the mesh
/// has already. Both give one symmetric tensor per vertex, as metric_of does.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// Asks for edges of this length everywhere. Thread safety: any thread.
AnyField constant_metric(const AnyMesh& mesh, double size);

/// Asks at each vertex for the geometric mean of the lengths of its edges, in every direction; a
/// vertex without any gets the mean of the whole mesh. Thread safety: any thread.
AnyField implied_metric(const AnyMesh& mesh);

}  // namespace ductile::meshadapt
