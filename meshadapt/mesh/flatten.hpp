/// @file
/// flatten: a mesh of triangles in a plane of space, as many programs write those of dimension 2,
/// becomes one of dimension 2. Thread safety of all: any thread.
#pragma once

#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// Turns a mesh of dimension 3 that has triangles and no tetrahedra into one of dimension 2 if one
/// coordinate, z rather than y or x, is the same at all corners of its triangles and edges: up to
/// 1e-6 of the extent of the others and the rounding of its own value to single precision. That
/// coordinate is dropped, see AnyMesh::dropped_axis; a line in `warnings`, if that is given, says
/// so. Any other mesh stays as it is. Throws InputError for arrays that do not fit together.
void flatten(AnyMesh& mesh, Warnings* warnings = nullptr);

/// What a mesh of dimension 3 without tetrahedra has instead and what may be done about it, to
/// follow what says that there are none; empty if it has no triangles.
std::string instead_of_tetrahedra(const AnyMesh& mesh);

}  // namespace ductile::meshadapt
