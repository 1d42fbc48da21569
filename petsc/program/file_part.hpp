/// @file
/// Conversion between a file's mesh and a part that holds all of it: references of facets and
/// elements serve as labels.
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

/// The label of required facets or elements with one reference.
struct KeptReference {
  std::int32_t label, reference;
};

/// The required entities of a mesh, and the meaning of its labels. A vertex's label is its index
/// here.
struct Kept {
  std::vector<KeptVertex> vertices;
  std::vector<KeptReference> facets, elements;  ///< in the order of labels
};

/// All of a mesh on one rank.
struct FilePart {
  Part part;
  Kept kept;
};

/// Makes a part of a mesh and its metric. Warns of data that several ranks do not keep: references
/// of vertices that may be removed. Throws InputError if no label is left for required entities.
FilePart part_of_file(meshadapt::AnyMesh mesh, meshadapt::AnyField metric,
                      meshadapt::Warnings& warnings);

/// Converts the part to a mesh for a file: restores references, and drops facets without one.
meshadapt::AnyMesh mesh_for_file(const Part& part, const Kept& kept);

/// Replaces labels of facets or elements by references. Returns the required ones.
std::vector<std::uint32_t> restore_references(std::vector<std::int32_t>& reference_of,
                                              const std::vector<KeptReference>& kept);

}  // namespace ductile::petsc
