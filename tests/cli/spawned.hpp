/// @file
/// Runs the real program without a shell, so that environment variables affect the program only.
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

/// Returns the exit status, or minus the signal that ended the child. Returns nothing, and kills
/// it, if it takes longer than `seconds`.
std::optional<int> wait_for(pid_t child, double seconds = 60);

/// The program's standard error since spawn().
std::string errors_of(const Folder& folder);

/// Adds a square of 8 triangles, s.mesh with s.sol, and two tetrahedra, t.mesh.
void add_small_meshes(const Folder& folder);

/// The bytes of each file in the folder by its name.
std::map<std::string, std::string> contents_of(const Folder& folder);

}  // namespace ductile::cli
