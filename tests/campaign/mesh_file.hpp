/// @file
/// The campaign's own reader and writer of GMF text files. The reader is strict: it refuses
/// whatever the program should not have written.
#pragma once

#include <filesystem>
#include <stdexcept>

#include "mesh.hpp"

namespace ductile::campaign {

/// Thrown if the file breaks the format.
struct BadFile : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void write_mesh(const std::filesystem::path& path, const Mesh& mesh);
void write_field(const std::filesystem::path& path, const Field& field);
Mesh read_mesh(const std::filesystem::path& path);    ///< Throws BadFile.
Field read_field(const std::filesystem::path& path);  ///< Throws BadFile.

}  // namespace ductile::campaign
