/// @file
/// A field of a file as the metric of a mesh: sizes or tensors at its vertices, checked.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// The longest size that a metric may ask for at a vertex, over the shortest.
inline constexpr double largest_anisotropy = 1e8;

/// Makes one symmetric tensor per vertex of a field that is either one scalar, the size h wanted,
/// which gives the metric 1/h^2 in every direction, or one symmetric tensor. Of a field of
/// dimension 3 for a mesh that read_mesh found flat, the part in the plane is taken. Throws
/// InputError, naming file and vertex (from 1, as in the file), unless there is a value for each
/// vertex, sizes are positive, tensors positive definite, and no size or anisotropy is beyond
/// reason. Thread safety: any thread.
AnyField metric_of(const AnyField& field, const AnyMesh& mesh);

}  // namespace ductile::meshadapt
