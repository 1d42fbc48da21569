/// @file
/// apart: does something in a process of its own, whose end is not that of the caller. Cairo
/// does not survive when memory runs out at some of its places.
#pragma once

#include <functional>
#include <string>

namespace ductile::cli {

/// Returns work(), which is called in a child process, or in this one where there can be none. What
/// it throws arrives here as an Error or InputError of the same text. If the child is ended, throws
/// std::bad_alloc.
std::string apart(const std::function<std::string()>& work);

}  // namespace ductile::cli
