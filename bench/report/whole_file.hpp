/// @file
/// write_whole: a file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace ductile::bench {

/// Under another name until it is whole. Throws std::runtime_error, naming the file, if it cannot
/// be written.
void write_whole(const std::filesystem::path& path, const std::string& text);

}  // namespace ductile::bench
