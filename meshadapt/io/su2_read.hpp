/// @file
/// Meshes of SU2 (private to io). Any thread.
#pragma once

#include <string_view>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "file_bytes.hpp"

namespace ductile::meshadapt {

/// Whether the bytes begin as such a file does: with a keyword of its own, after comments.
bool is_su2(std::string_view bytes);

/// Facets get the reference of their marker. Where the marker's name is a number, that is the
/// reference. Other markers get the numbers 1, 2, 3 and so on that are still free, in the order of
/// the file, and their names become names of references. Elements have reference 0. Throws
/// InputError.
AnyMesh read_su2(const FileBytes& bytes, Warnings* warnings);

}  // namespace ductile::meshadapt
