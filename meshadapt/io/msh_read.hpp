/// @file
/// Gmsh's files, versions 2.0 to 2.2 and 4.1, text and binary in either byte order (private to io).
/// Any thread.
#pragma once

#include <string_view>

#include "file_bytes.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Whether the bytes begin as such a file does, of any version.
bool is_msh(std::string_view bytes);

/// Throws InputError.
SpatialMesh read_msh(const FileBytes& bytes, Warnings* warnings);

}  // namespace ductile::meshadapt
