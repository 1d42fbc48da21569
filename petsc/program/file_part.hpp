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

/// What stands in for a reference in a part, of facets or elements that are required.
struct KeptReference {
  std::int32_t label, reference;
};

/// What stays of a mesh, and what its labels mean. That of a vertex is its index here.
struct Kept {
  std::vector<KeptVertex> vertices;
  std::vector<KeptReference> facets, elements;  ///< in the order of labels
};

/// All of a mesh on one rank.
struct FilePart {
  Part part;
  Kept kept;
};

/// Of a mesh and its metric. Says in `warnings` what is not carried on several ranks: references of
/// vertices that may go. Throws InputError if no label is left for what is required.
FilePart part_of_file(meshadapt::AnyMesh mesh, meshadapt::AnyField metric,
                      meshadapt::Warnings& warnings);

/// The part as a mesh for a file: references in place of labels, no facets without one.
meshadapt::AnyMesh mesh_for_file(const Part& part, const Kept& kept);

/// Puts references in the place of labels, of facets and elements. Returns which are required.
std::vector<std::uint32_t> restore_references(std::vector<std::int32_t>& reference_of,
                                              const std::vector<KeptReference>& kept);

}  // namespace ductile::petsc
