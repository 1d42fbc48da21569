/// @file
/// apart: works in a child process, because cairo ends the process at some places if memory runs
/// out.
#pragma once

#include <functional>
#include <string>

namespace ductile::cli {

/// Returns work(), which runs in a child process, or in this one if there can be none. An exception
/// of it is thrown here as an Error or InputError with the same text; std::bad_alloc if the child
/// is ended.
std::string apart(const std::function<std::string()>& work);

}  // namespace ductile::cli
