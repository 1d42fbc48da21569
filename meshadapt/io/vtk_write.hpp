/// @file
/// VTK's legacy files, version 4.2, which all readers know, text and binary (private to io). Any
/// thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Stages the file. Throws InputError.
void write_vtk(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
