/// @file
/// Which references of vertices mark points to be kept, such as Gmsh's physical points, and which
/// say on what line, surface or region vertices lie, as FreeFEM and Gmsh write them.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// [vertex] 1 where its reference marks a point. It does if at most 8 vertices, or fewer than half
/// of all, have a reference other than 0 and its own is not that of a line or more: of all corners
/// of an element or a listed triangle of tetrahedra, or of three vertices along listed edges.
/// Thread safety: any thread.
std::vector<std::uint8_t> marked_points(const AnyMesh& mesh);

}  // namespace ductile::meshadapt
