/// @file
/// Runs a program as a child process under a time limit and tells how it ended.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ductile::campaign {

struct Ending {
  enum class How { exited, crashed, timed_out } how = How::exited;
  int status = 0;       ///< exit status, or the signal that ended it
  double seconds = 0;   ///< wall time
  std::string message;  ///< what it wrote to standard error, its first 4,000 bytes
};

/// `words[0]` is the program; standard output goes nowhere. It runs in `folder`. It times out when
/// it has used `limit_s` of processor time, all threads together, or five times that has gone by.
Ending run(const std::vector<std::string>& words, const std::filesystem::path& folder,
           double limit_s);

}  // namespace ductile::campaign
