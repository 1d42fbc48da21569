/// @file
/// The table of formats (private to io): a new one is a row here and a file that reads or writes
/// it.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

#include "ductile/meshadapt/files.hpp"
#include "file_bytes.hpp"

namespace ductile::meshadapt {

struct FormatRow : MeshFormat {
  bool (*is_it)(std::string_view bytes);  ///< whether a file begins so; null: not by its content
  MeshWithFields (*read)(const FileBytes& bytes, Warnings* warnings);  ///< null: not read
  void (*write)(AtomicOutputs& outputs, const std::filesystem::path& path, const AnyMesh& mesh,
                const WriteOptions& options);  ///< null: not written
};

std::span<const FormatRow> format_rows();

}  // namespace ductile::meshadapt
