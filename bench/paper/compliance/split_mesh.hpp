/// @file
/// split_in_four: a plane mesh with each triangle cut into four alike. What is linear in the old
/// triangles is linear in the new ones, so a field on the mesh loses nothing: a finer mesh to judge
/// it on.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::paper {

/// The old vertices keep their numbers; references are kept, lists of required entities are not.
meshadapt::AnyMesh split_in_four(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::paper
