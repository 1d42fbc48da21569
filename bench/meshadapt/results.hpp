/// @file
/// Results: all measurements, and their JSON file.
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

  /// Is every result valid, and the same at all threads for each case and mode?
  bool sound() const;
};

/// The file appears whole or not at all. Throws std::runtime_error, naming it, if it cannot be
/// written.
void write_json(const Results& results, const std::filesystem::path& path);

}  // namespace ductile::bench
