/// @file
/// Other programs, run and measured as whole processes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ductile::bench {

/// What a process took from its start to its end.
struct ChildReport {
  int status = 0;  ///< exit status; 128 + the signal that ended it; 127 if it could not be started
  double processor_seconds = 0;  ///< user and system
  double wall_seconds = 0;
  std::size_t peak_memory = 0;  ///< bytes, as seen every 10 ms
};

/// Runs words[0] with the others as arguments, and waits for it. What it prints is thrown away.
ChildReport run_child(const std::vector<std::string>& words);

/// Where a program of this name lies on the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace ductile::bench
