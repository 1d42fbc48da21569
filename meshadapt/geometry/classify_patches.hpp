/// @file
/// Patches: which boundary and interface facets form one, flat or, with a tolerance, smooth.
#pragma once

#include "geometry/boundary_parts.hpp"

namespace ductile::meshadapt {

/// Sets mesh.patches and the facets' patches, and of smooth ones `kept`, `wide_normals` and
/// `plane_of`. Thread safety: one caller; runs on the executor.
template <int Dim>
void classify_patches(BoundaryParts<Dim>& parts);

extern template void classify_patches(BoundaryParts<2>&);
extern template void classify_patches(BoundaryParts<3>&);

}  // namespace ductile::meshadapt
