/// @file
/// Options of the suite, parsed from a command line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "arguments.hpp"

namespace ductile::bench::irregular {

struct Options {
  std::vector<std::string> only;  ///< names of algorithms; all if empty
  std::vector<std::size_t> sizes{100000, 1000000};
  std::vector<int> threads{1, 2};
  int repetitions = 5;
  std::filesystem::path json;  ///< none if empty
  bool help = false;
};

using cli::UsageError;

std::span<const cli::Option> known_options();

/// Throws UsageError, which names the word and what was expected.
Options options_from(const std::vector<std::string>& words);

}  // namespace ductile::bench::irregular
