/// @file
/// fills_unit_box: whether a mesh still is one of the unit square or cube.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::bench {

/// Whether the elements of a mesh lie in the unit square or cube and have its measure, to 1e-9. A
/// valid mesh may fail to: check_mesh knows nothing of the domain.
bool fills_unit_box(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::bench
