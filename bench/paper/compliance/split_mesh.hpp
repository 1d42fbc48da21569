/// @file
/// split_in_four: a plane mesh with each triangle cut into four similar ones. Linear functions on
/// old triangles are linear on the new ones, so a field loses nothing on this finer mesh.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::paper {

/// The old vertices keep their numbers; references are kept, lists of required entities are not.
meshadapt::AnyMesh split_in_four(const meshadapt::AnyMesh& mesh);

}  // namespace ductile::paper
