/// @file
/// Runs the real program without a shell, so that what is set in the environment meets it alone.
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program.hpp"

namespace ductile::cli {

using Environment = std::map<std::string, std::string>;

/// Starts `ductile WORDS` in the folder; its standard output and error go to the files `out` and
/// `err` beside the folder. Words are separated by single spaces.
pid_t spawn(const Folder& folder, const std::string& words, const Environment& more = {});

/// How it ended: its exit status, or minus the signal that ended it. Nothing if it takes longer
/// than so many seconds; then it is killed.
std::optional<int> wait_for(pid_t child, double seconds = 60);

/// What it has written on standard error since spawn().
std::string errors_of(const Folder& folder);

/// Adds a square of 8 triangles, s.mesh with s.sol, and two tetrahedra, t.mesh.
void add_small_meshes(const Folder& folder);

/// The bytes of each file in the folder by its name.
std::map<std::string, std::string> contents_of(const Folder& folder);

}  // namespace ductile::cli
