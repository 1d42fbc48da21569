/// @file
/// What may be wrong with the place of an output although a file can be made beside it: found
/// before the work, not when the finished file is to be put there.
#pragma once

#include <filesystem>

namespace ductile::meshadapt {

/// Throws InputError if a name is longer than the system takes, or a link leads to itself.
void expect_name_to_lead_somewhere(const std::filesystem::path& path);

/// Throws InputError if nothing may be put at this place, or what is there may not be replaced by
/// another file: in folders where only owners may do that, or that may only be added to, and where
/// something is mounted there. `path` is no link.
void expect_replaceable(const std::filesystem::path& path);

}  // namespace ductile::meshadapt
