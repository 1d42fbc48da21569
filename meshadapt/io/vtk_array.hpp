/// @file
/// The text of one array in a VTK XML file of format "binary": cut into blocks, each compressed by
/// zlib, the table of their sizes in front, all of it in base64. Numbers have the byte order of
/// this machine. Any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace ductile::meshadapt {

/// Throws Error if zlib runs out of memory.
std::string vtk_encoded(std::span<const std::byte> array);

}  // namespace ductile::meshadapt
