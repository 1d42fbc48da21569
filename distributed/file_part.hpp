/// @file
/// Conversion between a file's mesh and a part that holds all of it: references of facets and
/// elements serve as labels.
#pragma once

#include <cstdint>
#include <vector>

#include "distributed/part.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

/// A vertex that adaptation leaves where it is.
struct KeptVertex {
  std::int32_t reference;
  std::uint8_t is_required, is_corner;
};

/// The label of required facets or elements with one reference.
struct KeptReference {
  std::int32_t label, reference;
};

/// The data of a file's mesh that parts do not hold: its required entities, the meaning of labels,
/// names. A vertex's label is its index here.
struct Kept {
  std::vector<KeptVertex> vertices;
  std::vector<KeptReference> facets, elements;  ///< in the order of labels
  std::vector<meshadapt::ReferenceName> names;  ///< of references
  int dropped_axis = 2;                         ///< as in AnyMesh
};

/// All of a mesh on one rank.
struct FilePart {
  Part part;
  Kept kept;
};

/// Makes a part of a mesh and its metric. Vertices whose reference marks a point, such as Gmsh's
/// physical points, are kept, as adapt() does. Warns of data that several ranks do not keep: other
/// references of vertices that are not required, and listed edges that belong to no tetrahedron.
/// Throws InputError if no label is left for required entities.
FilePart part_of_file(const runtime::Executor& executor, meshadapt::AnyMesh mesh,
                      meshadapt::AnyField metric, meshadapt::Warnings& warnings);

/// Converts the part to a mesh for a file: restores references and names, and drops facets without
/// a reference.
meshadapt::AnyMesh mesh_for_file(const Part& part, const Kept& kept);

/// Replaces labels of facets or elements by references. Returns the required ones.
std::vector<std::uint32_t> restore_references(std::vector<std::int32_t>& reference_of,
                                              const std::vector<KeptReference>& kept);

}  // namespace ductile::distributed
