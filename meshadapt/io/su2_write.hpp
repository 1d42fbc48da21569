/// @file
/// Meshes for SU2 (private to io). Any thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Stages the file. Facets are in markers by the names of their references, or the references
/// themselves; references of elements have no place. Throws InputError.
void write_su2(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
