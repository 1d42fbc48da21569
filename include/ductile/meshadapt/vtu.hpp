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

/// Values at the vertices under the name that ParaView shows. In the file, vectors have three
/// components and tensors nine; those that the plane lacks are 0.
struct VtuField {
  std::string name;
  AnyField::Type type = AnyField::Type::scalar;
  std::vector<double> values;  ///< [vertex * component_count + component], order as in AnyField
};

/// The fields of an AnyField apart: "NAME", or "NAME_1", "NAME_2", ... if there are several.
/// Throws InputError unless there are values for all vertices. Thread safety: any thread.
std::vector<VtuField> vtu_fields(const AnyField& field, const std::string& name);

/// Writes the mesh and fields of its dimension at its vertices. The file appears whole or not at
/// all. Throws InputError for a place that cannot be written, cells that name vertices beyond those
/// that there are, arrays whose lengths do not belong together, and names that are not UTF-8 or
/// have control characters, which XML cannot hold; Error if the disk fills up. Thread safety: any
/// thread.
void write_vtu(const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<VtuField>& fields = {});

/// The same as one of several outputs that appear together.
void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<VtuField>& fields = {});

}  // namespace ductile::meshadapt
