/// @file
/// ball_in_box: a mesh of two regions with a round interface.
#pragma once

#include <cstdint>
#include <set>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt::test {

inline constexpr std::int32_t ball_inside = 3, ball_outside = 2, ball_interface = 10;

/// n cells (even) along each axis of the cube from -1 to 1, mapped so that the vertices of the
/// inner ones lie in a ball of this radius around 0, below 1; those of the interface are on it.
AnyMesh ball_in_box(int dimension, int n, double radius);

/// Vertices of listed facets with the reference ball_interface.
std::set<std::uint32_t> interface_vertices(const AnyMesh& mesh);

}  // namespace ductile::meshadapt::test
