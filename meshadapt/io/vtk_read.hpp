/// @file
/// VTK's legacy files with an unstructured grid, versions 1 to 5.1, text and binary (private to
/// io). Any thread.
#pragma once

#include <string_view>

#include "file_bytes.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

bool is_vtk(std::string_view bytes);

/// Throws InputError.
SpatialMesh read_vtk(const FileBytes& bytes, Warnings* warnings);

}  // namespace ductile::meshadapt
