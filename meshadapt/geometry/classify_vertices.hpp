/// @file
/// The freedom of every vertex of a mesh: to stay, to move along its curve or in its patch, or
/// everywhere.
#pragma once

#include "geometry/boundary_parts.hpp"

namespace ductile::meshadapt {

/// Sets kind_of.class_dimension and entity_of from mesh.patches, curves and links_of. Thread
/// safety: one caller; runs on the executor.
template <int Dim>
void classify_vertices(const BoundaryParts<Dim>& parts);

extern template void classify_vertices(const BoundaryParts<2>&);
extern template void classify_vertices(const BoundaryParts<3>&);

}  // namespace ductile::meshadapt
