/// @file
/// read_level_set_references(): the materials of a cut, from a parameter file of Mmg's.
#pragma once

#include <filesystem>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/level_set.hpp"

namespace ductile::meshadapt {

/// Reads Mmg's parameter file, NAME.mmg2d or NAME.mmg3d: the word LSReferences, a count, and for
/// each material its reference and either the word nosplit or the references of its parts below and
/// above the level. Empty if the file has none. LSBaseReferences are ignored, with a line in
/// `warnings` if given; sizes are for read_local_sizes(). Throws InputError ("FILE:LINE: expected,
/// found"). Thread safety: any thread.
std::vector<CutMaterial> read_level_set_references(const std::filesystem::path& path,
                                                   Warnings* warnings = nullptr);

}  // namespace ductile::meshadapt
