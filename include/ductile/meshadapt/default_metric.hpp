/// @file
/// The metrics to adapt to when the user has none: one size everywhere, or the sizes that the mesh
/// has already, in all directions alike or as they are. All give one symmetric tensor per vertex,
/// as metric_of does.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Asks for edges of this length everywhere. Thread safety: any thread.
AnyField constant_metric(const AnyMesh& mesh, double size);

/// Asks at each vertex for the geometric mean of the lengths of its edges, in every direction; a
/// vertex without any gets the mean of the whole mesh. Throws InputError for lengths beyond the
/// sizes that a metric may ask for, for vertices without coordinates or reference, and for elements
/// that name others. Thread safety: any thread.
AnyField implied_metric(const AnyMesh& mesh);

/// The metric that the mesh is adapted to already, stretched as it is: for each element there is
/// one in which all its edges have length 1; a vertex gets the mean of their logarithms around it,
/// weighted by volume. A vertex without elements asks for a size of 1. Throws InputError if the
/// mesh is not valid (see make_fixed_mesh). Thread safety: one caller; runs on the executor.
AnyField implied_tensors(const runtime::Executor& executor, const AnyMesh& mesh);

}  // namespace ductile::meshadapt
