/// @file
/// Checks that the arrays of a mesh or of fields made by a caller have consistent lengths, before
/// anything is looked up in them. Indices are checked elsewhere.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// The number of triangles, in the plane or of a surface, or of tetrahedra.
inline std::size_t element_count(const AnyMesh& mesh) {
  return element_dimension(mesh) == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

/// Throws InputError unless the mesh is of dimension 2 or 3 and each vertex has its coordinates and
/// its reference.
void expect_coordinates(const AnyMesh& mesh);

/// Throws InputError unless there is a reference for each edge, triangle and tetrahedron.
void expect_references(const AnyMesh& mesh);

/// Throws InputError unless the fields have known types, dimension 2 or 3, and the right number of
/// values.
void expect_values(const AnyField& field);

}  // namespace ductile::meshadapt
