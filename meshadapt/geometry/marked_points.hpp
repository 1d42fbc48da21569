/// @file
/// Which references of vertices mark points to be kept, such as Gmsh's physical points, and which
/// say on what line, surface or region vertices lie, as FreeFEM and Gmsh write them.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// [vertex] 1 where its reference marks a point. Where at most 8 vertices have a reference other
/// than 0, all of them do. Where half of all vertices or more have one, none does. Otherwise those
/// do whose reference is not that of a line or more: of all corners of an element or a listed
/// triangle, or of three vertices along listed edges. Thread safety: any thread.
std::vector<std::uint8_t> marked_points(const AnyMesh& mesh);

}  // namespace ductile::meshadapt
