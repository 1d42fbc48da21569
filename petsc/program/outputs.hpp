/// @file
/// Outputs of a distributed mesh: gathered on the first rank, a piece for each rank, or PETSc's
/// HDF5. Files appear whole or not at all; the index of pieces, the .pvtu, appears last.
#pragma once

#include <filesystem>
#include <vector>

#include "adapt_parts.hpp"
#include "communicator.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/runtime/executor.hpp"
#include "file_part.hpp"

namespace ductile::petsc {

/// A mesh with the fields at its vertices and elements, in parts.
struct DistributedResult {
  AdaptedParts parts;
  std::vector<meshadapt::NamedField> fields;
  Kept kept;
  std::vector<meshadapt::ReferenceName> names;  ///< of references
  int dropped_axis = 2;                         ///< as in AnyMesh
};

/// The whole result on the first rank; an empty mesh on the others. Vertices are in the order of
/// their numbers, elements in that of the ranks. Throws Error, on all ranks. Collective.
meshadapt::MeshWithFields gathered(const Communicator& comm, const runtime::Executor& executor,
                                   const DistributedResult& result);

/// Writes PATH, a .pvtu, and PATH_RANK.vtu beside it from each rank that has elements. If that
/// fails, there is no PATH, rather than one that names pieces of two runs. Throws Error, on all
/// ranks. Collective.
void write_pieces(const Communicator& comm, const std::filesystem::path& path,
                  const DistributedResult& result);

/// Writes a file that DMPlex reads and draws, with references as the labels "Face Sets", "Cell
/// Sets", "Vertex Sets" and in 3D "Edge Sets", and fields as "vertex_fields" and "cell_fields".
/// Throws Error, on all ranks. Collective.
void write_hdf5(const Communicator& comm, const std::filesystem::path& path,
                const DistributedResult& result);

}  // namespace ductile::petsc
