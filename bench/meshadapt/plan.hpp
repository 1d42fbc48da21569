/// @file
/// Plan: which cases are measured, at which sizes, on how many threads and how often.
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
  double seconds = 120;  ///< no further repetition of a case, or pair, is begun after so long
  bool peers = true;
};

std::span<const cli::Option> plan_options();

/// Throws UsageError.
Plan plan_from(const cli::Arguments& arguments);

/// What to measure of a case: 1, 2, 4, ... threads, and by colours on the fewest and the most. Of
/// a large one, NAME@FACTOR with a factor above 1, only the most threads.
std::vector<RunSettings> settings_for(const Plan& plan, const std::string& case_name);

/// Whether it is measured for its size only.
bool is_large(const std::string& case_name);

}  // namespace ductile::bench
