/// @file
/// Results: all that was measured, and the JSON file that tells it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "copies.hpp"
#include "peer.hpp"
#include "sample.hpp"

namespace ductile::bench {

struct Results {
  std::vector<Sample> samples;
  std::vector<CopiesRow> copies;
  std::vector<Pair> pairs;
  std::vector<std::string> notes;  ///< what was not measured, and why

  /// Whether every result is valid, and of each case and mode the same at all threads.
  bool sound() const;
};

/// The file appears whole or not at all. Throws std::runtime_error, naming it, if it cannot be
/// written.
void write_json(const Results& results, const std::filesystem::path& path);

}  // namespace ductile::bench
