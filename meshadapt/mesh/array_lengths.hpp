/// @file
/// Whether the arrays of a mesh or of fields that a caller made have the lengths that belong
/// together, to be asked before anything is looked up in them; indices are another matter.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// Throws InputError unless the mesh is of dimension 2 or 3 and each vertex has its coordinates and
/// its reference.
void expect_coordinates(const AnyMesh& mesh);

/// Throws InputError unless there is a reference for each edge, triangle and tetrahedron.
void expect_references(const AnyMesh& mesh);

/// Throws InputError unless there are fields of known types, of dimension 2 or 3, that have as many
/// values as they should.
void expect_values(const AnyField& field);

}  // namespace ductile::meshadapt
