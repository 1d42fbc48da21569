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

/// A marker that is called by a number is the reference of its facets; others are named references,
/// numbered from 1 in their order, but for numbers that markers are called by. Elements have
/// reference 0. Throws InputError.
AnyMesh read_su2(const FileBytes& bytes, Warnings* warnings);

}  // namespace ductile::meshadapt
