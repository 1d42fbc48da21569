/// @file
/// Surfaces as binary STL (private to io). Any thread.
#pragma once

#include <filesystem>

#include "ductile/meshadapt/files.hpp"

namespace ductile::meshadapt {

/// Stages the file: the triangles on the boundary of a mesh of dimension 3, seen from outside, in
/// single precision. Throws InputError, for meshes of dimension 2, too.
void write_stl(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
               const WriteOptions& options);

}  // namespace ductile::meshadapt
