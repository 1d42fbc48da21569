/// @file
/// Runs a program as a child process under a time limit and reports how it ended.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ductile::campaign {

struct Ending {
  enum class How { exited, crashed, timed_out } how = How::exited;
  int status = 0;       ///< exit status, or the signal that ended it
  double seconds = 0;   ///< wall time
  std::string message;  ///< the first 4,000 bytes of its standard error
};

/// Runs the program words[0] in `folder` and discards its standard output. Times out after
/// `limit_s` seconds of processor time of all threads together, or after five times that on the
/// clock.
Ending run(const std::vector<std::string>& words, const std::filesystem::path& folder,
           double limit_s);

}  // namespace ductile::campaign
