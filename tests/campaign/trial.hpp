/// @file
/// One trial: writes a case to files, runs the program on it, and checks the output.
#pragma once

#include <filesystem>
#include <string>

#include "case.hpp"

namespace ductile::campaign {

struct Settings {
  std::filesystem::path program;  ///< ductile
  double limit_s = 20;            ///< of each run
  bool level_sets = true;         ///< cuts the mesh of some cases, too
  bool all_checks = false;        ///< closure and other numbers of threads for each case
};

enum class Verdict { right, refused, wrong, crash, timeout };

struct Outcome {
  Verdict verdict = Verdict::right;
  Faults faults;        ///< a line each; what was wrong, or the message of a refusal
  double seconds = 0;   ///< of the longest run
  bool rested = true;   ///< the third call changed less than 2 % of elements
  bool closed = false;  ///< was adapted again, so `rested` is valid
};

/// Runs the case in `folder`, which keeps all files and a script `run.sh` that repeats the calls.
/// `seed` decides which checks follow the first call.
Outcome try_case(const Case& tried, std::uint64_t seed, const std::filesystem::path& folder,
                 const Settings& settings);

}  // namespace ductile::campaign
