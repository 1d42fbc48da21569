/// @file
/// curved_mesh: domains with curved boundaries, to start from.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::bench {

/// All between the radii 1/2 and 1 and within an angle of 1 to either side, in 3D of longitude and
/// of latitude: a sector of a ring, or of a hollow ball. `cells` along an angle, a fourth of that
/// along the radius, cut as those of box_mesh(), with their references.
meshadapt::AnyMesh curved_mesh(int dimension, int cells);

}  // namespace ductile::bench
