/// @file
/// Gmsh's files, versions 2.2 and 4.1, text and binary (private to io). Any thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Stages the file. References become physical groups of that number, and entities of the geometry,
/// too; vertices with a reference other than 0 become points. Throws InputError.
void write_msh(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
