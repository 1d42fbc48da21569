/// @file
/// Plan: the cases to measure, their sizes, the numbers of threads and repetitions.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "sample.hpp"

namespace ductile::bench {

struct Plan {
  std::vector<std::string> cases;
  std::filesystem::path folder;
  int most_threads = 1;
  int repetitions = 5;
  int pairs = 3;
  double seconds = 120;  ///< no further repetition of a case, or pair, begins after this time
  bool peers = true;
};

std::span<const cli::Option> plan_options();

/// Throws UsageError.
Plan plan_from(const cli::Arguments& arguments);

/// Settings for a case: 1, 2, 4, ... threads, and by colours on the fewest and the most threads. A
/// large case, NAME@FACTOR with a factor above 1, runs on the most threads only.
std::vector<RunSettings> settings_for(const Plan& plan, const std::string& case_name);

/// Is the case measured on the most threads only, because it is large?
bool is_large(const std::string& case_name);

}  // namespace ductile::bench
