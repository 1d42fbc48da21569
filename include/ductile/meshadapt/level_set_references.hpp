/// @file
/// read_level_set_references(): the materials of a cut, from a parameter file of Mmg's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {

/// A line of LSReferences; a CutMaterial has the same fields.
struct LevelSetReference {
  std::int32_t reference = 0;
  bool split = true;
  std::int32_t minus = 0, plus = 0;  ///< references below and above the level if it is split
};

/// Reads Mmg's parameter file, NAME.mmg2d or NAME.mmg3d: the word LSReferences, a count, and for
/// each material its reference and either the word nosplit or the references of its parts below and
/// above the level. Empty if the file has none. LSBaseReferences are ignored, with a line in
/// `warnings` if given; sizes are for read_local_sizes(). Throws InputError ("FILE:LINE: expected,
/// found"). Thread safety: any thread.
std::vector<LevelSetReference> read_level_set_references(const std::filesystem::path& path,
                                                         Warnings* warnings = nullptr);

}  // namespace ductile::meshadapt
