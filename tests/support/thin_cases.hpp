/// @file
/// thin_cases: random meshes whose boundary comes close to itself, or touches itself, with a size
/// and a surface tolerance that is often larger than the distance between the sides.
#pragma once

#include <cstdint>
#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

struct ThinCase {
  AnyMesh mesh;
  double size = 0;       ///< of edges
  double tolerance = 0;  ///< of the surface
  std::string what;
};

/// A plate, flat or bent, with one or several voids of a few elements, none of which touches
/// another; some touch the surface of the plate.
ThinCase plate_with_voids(int dimension, std::uint64_t seed);

/// A plate from which elements are missing here and there, so that voids share corners and edges.
ThinCase plate_with_joined_voids(int dimension, std::uint64_t seed);

/// A block, wavy or bent, with a closed crack: its facets and vertices are doubled, except for the
/// vertices on the crack's rim, which lies inside or on the boundary.
ThinCase curved_crack(int dimension, std::uint64_t seed);

/// Two bodies along a curved surface, which they share or which is doubled with a gap of 0 to 1e-9;
/// they share no vertices, or some.
ThinCase bodies_in_contact(int dimension, std::uint64_t seed);

}  // namespace ductile::meshadapt::test
