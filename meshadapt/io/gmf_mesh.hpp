/// @file
/// Meshes in GMF files (private to io). Any thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"
#include "file_bytes.hpp"

namespace ductile::meshadapt {

/// Throws InputError.
AnyMesh read_gmf(const FileBytes& bytes, Warnings* warnings);

/// Stages the file. Throws InputError.
void write_gmf(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
