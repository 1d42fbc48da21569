/// @file
/// flatten: converts a planar mesh of triangles in space, as many programs write meshes of
/// dimension 2, to dimension 2. Thread safety of all: any thread.
#pragma once

#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// Turns a mesh of dimension 3 with triangles and no tetrahedra into one of dimension 2 if one
/// coordinate (preferably z, then y, then x) is the same at all corners of its triangles and edges,
/// up to 1e-6 of the extent of the others and the rounding of its value to single precision. Drops
/// that coordinate, see AnyMesh::dropped_axis, and adds a line to `warnings` if given. Keeps any
/// other mesh. Throws InputError for inconsistent arrays.
void flatten(AnyMesh& mesh, Warnings* warnings = nullptr);

/// The end of a message about a mesh of dimension 3 without tetrahedra: its other contents and a
/// remedy; empty if it has no triangles.
std::string instead_of_tetrahedra(const AnyMesh& mesh);

}  // namespace ductile::meshadapt
