/// @file
/// Files of other programs that are not read: what they are, and how to convert them (private to
/// io). Any thread.
#pragma once

#include "file_bytes.hpp"

namespace ductile::meshadapt {

/// Throws InputError with the format that the file seems to have and a conversion that works, if it
/// begins as a file of a format that is known but not read, or its name ends so.
void refuse_foreign(const FileBytes& bytes);

}  // namespace ductile::meshadapt
