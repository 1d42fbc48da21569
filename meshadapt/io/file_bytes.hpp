/// @file
/// FileBytes: the bytes of an input file in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "ductile/runtime/arrays.hpp"

namespace ductile::meshadapt {

struct FileBytes {
  std::string name;                 ///< as the user gave it, for messages
  runtime::UnsetVector<char> data;  ///< the first `size` bytes
  std::size_t size = 0;

  const char* begin() const { return data.data(); }
  const char* end() const { return data.data() + size; }
};

/// Reads a file, or a pipe to its end. Throws InputError if there is none, if it is a folder or a
/// device, is empty or cannot be read. Thread safety: any thread.
FileBytes read_bytes(const std::filesystem::path& path);

}  // namespace ductile::meshadapt
