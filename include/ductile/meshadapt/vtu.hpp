/// @file
/// Meshes and fields for ParaView: a VTK unstructured grid (.vtu), XML with compressed arrays.
/// Cells are the tetrahedra, triangles and edges of the mesh, in this order, with their references
/// in the array "reference".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/atomic_file.hpp"

namespace ductile::meshadapt {

/// Writes the mesh and fields of its dimension at its vertices. Vectors get three components and
/// tensors nine; those that the plane lacks are 0. The file appears whole or not at
/// all. Throws InputError for a place that cannot be written, cells that name vertices beyond those
/// that there are, arrays whose lengths do not belong together, and names that are not UTF-8 or
/// have control characters, which XML cannot hold; Error if the disk fills up. Thread safety: any
/// thread.
void write_vtu(const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields = {});

/// The same as one of several outputs that appear together.
void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields = {});

}  // namespace ductile::meshadapt
