/// @file
/// VTK's unstructured grids in XML, in all encodings that VTK writes but those of lz4 and lzma
/// (private to io). Any thread.
#pragma once

#include <string_view>

#include "file_bytes.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Whether the bytes begin as such a file does, of any type of grid.
bool is_vtu(std::string_view bytes);

/// Throws InputError.
SpatialMesh read_vtu(const FileBytes& bytes, Warnings* warnings);

}  // namespace ductile::meshadapt
