/// @file
/// Decodes the numbers of one array in a VTK file: text, base64 or raw bytes, whole or in blocks
/// compressed by zlib (private to io). Any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "number_reader.hpp"

namespace ductile::meshadapt {

/// The encoding of the arrays of a file.
struct VtkEncoding {
  bool swapped = false;        ///< the other byte order
  bool compressed = false;     ///< by zlib
  std::size_t head_bytes = 4;  ///< of the numbers in front of an array, 4 or 8
};

/// The bytes of an array, and how many bytes of the file it takes.
struct VtkDecoded {
  std::string bytes;
  std::size_t taken = 0;
};

/// Decodes base64 as far as it goes, or raw bytes. Memory in proportion to `encoded`.
/// Throws InputError with a text about what is wrong, which lacks the name of the file.
VtkDecoded vtk_decoded(std::string_view encoded, bool base64, const VtkEncoding& encoding);

/// Real numbers, or whole ones, out of their bytes or text. Throw InputError as above.
std::vector<double> vtk_reals(std::string_view bytes, NumberKind kind, bool swapped);
std::vector<double> vtk_reals(std::string_view text);

}  // namespace ductile::meshadapt
