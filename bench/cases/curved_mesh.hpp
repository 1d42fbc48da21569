/// @file
/// curved_mesh: start meshes with curved boundaries.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::bench {

/// A sector of a ring (3D: of a hollow ball), between the radii 1/2 and 1 and from -1 to 1 in angle
/// (3D: in longitude and latitude). It has `cells` cells along each angle and a fourth of that
/// along the radius, cut like those of box_mesh() and with their references.
meshadapt::AnyMesh curved_mesh(int dimension, int cells);

}  // namespace ductile::bench
