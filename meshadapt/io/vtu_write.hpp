/// @file
/// VTK's unstructured grids in XML, with compressed arrays (private to io). Any thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Stages the file. Throws InputError.
void write_vtu(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
