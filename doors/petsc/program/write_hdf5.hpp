/// @file
/// A distributed mesh as a file of PETSc's HDF5.
#pragma once

#include <filesystem>

#include "distributed/pieces.hpp"

namespace ductile::petsc {

/// Writes a file that DMPlex reads and draws, with references as the labels "Face Sets", "Cell
/// Sets", "Vertex Sets" and in 3D "Edge Sets", and fields as "vertex_fields" and "cell_fields".
/// Throws Error, on all ranks. Collective.
void write_hdf5(const distributed::Communicator& comm, const std::filesystem::path& path,
                const distributed::DistributedResult& result);

}  // namespace ductile::petsc
