/// @file
/// Metrics for users without one: a constant size, or the mesh's implied metric, isotropic or
/// anisotropic. All give one symmetric tensor per vertex, as metric_of does.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Asks for edges of this length everywhere. Throws InputError unless it is from 1e-75 to 1e75 and
/// vertices have coordinates and references. Thread safety: any thread.
AnyField constant_metric(const AnyMesh& mesh, double size);

/// Asks for edges as long as this, or as the diagonal of the box around the mesh if it is 0,
/// everywhere: for nothing but what limits on sizes ask for, see AdaptOptions::curved_sizes. Throws
/// InputError unless it is 0 or from 1e-75 to 1e75 and vertices have coordinates and references.
/// Thread safety: any thread.
AnyField coarsest_metric(const AnyMesh& mesh, double largest_size = 0);

/// What the program adapts a mesh to when no metric is given: the sizes that the mesh has, in the
/// directions in which it has them, so that stretched elements and layers stay and the number of
/// elements is about the same. At each vertex it has the shape of implied_tensors(), and in it the
/// geometric mean of the lengths of the vertex's edges is 1. Where sizes differ by less than a
/// factor of 2 between the directions, which is by chance in any isotropic mesh, it is isotropic;
/// up to a factor of 4 it is partly so. Elements need not have a volume: flat ones count for
/// nothing. A vertex without elements gets the mean size of the whole mesh. Throws InputError for
/// lengths beyond the sizes that a metric may ask for, for vertices without coordinates or
/// reference, and for elements that name others. Thread safety: one caller; runs on the executor.
AnyField default_metric(const runtime::Executor& executor, const AnyMesh& mesh);

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
