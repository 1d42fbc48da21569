/// @file
/// What a file says, as a part that holds all of a mesh, and back: references of facets and
/// elements stand in for labels.
#pragma once

#include <cstdint>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "part.hpp"

namespace ductile::petsc {

/// A vertex that adaptation leaves where it is.
struct KeptVertex {
  std::int32_t reference;
  std::uint8_t is_required, is_corner;
};

/// All of a mesh on one rank. The label of a vertex is its index in `kept`.
struct FilePart {
  Part part;
  std::vector<KeptVertex> kept;
};

/// Of a mesh and its metric. Says in `warnings` what is not carried on several ranks: edges of
/// tetrahedra, and references of vertices that may go. Throws InputError for facets and elements
/// that are required.
FilePart part_of_file(meshadapt::AnyMesh mesh, meshadapt::AnyField metric,
                      meshadapt::Warnings& warnings);

/// The part as a mesh for a file: references in place of labels, no facets without one.
meshadapt::AnyMesh mesh_for_file(const Part& part, const std::vector<KeptVertex>& kept);

}  // namespace ductile::petsc
