/// @file
/// FileBytes: the whole of an input file in memory, as parsers want it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace ductile::meshadapt {

struct FileBytes {
  std::string name;              ///< as the user gave it, for messages
  std::unique_ptr<char[]> data;  ///< `size` bytes
  std::size_t size = 0;

  const char* begin() const { return data.get(); }
  const char* end() const { return data.get() + size; }
};

/// Reads a file, or a pipe to its end. Throws InputError if there is none, if it is a folder or a
/// device, is empty or cannot be read. Thread safety: any thread.
FileBytes read_bytes(const std::filesystem::path& path);

}  // namespace ductile::meshadapt
