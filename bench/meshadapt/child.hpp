/// @file
/// Runs other programs and measures them as whole processes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ductile::bench {

/// Resources used by a process from start to end.
struct ChildReport {
  int status = 0;  ///< exit status; 128 + the signal that ended it; 127 if it could not be started
  double processor_seconds = 0;  ///< user and system
  double wall_seconds = 0;
  std::size_t peak_memory = 0;  ///< bytes, as seen every 10 ms
};

/// Runs words[0] with the other words as arguments and waits for it. Its output is discarded.
ChildReport run_child(const std::vector<std::string>& words);

/// The path of a program on the PATH, if it is there.
std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace ductile::bench
