/// @file
/// A campaign: runs trials on all cores until time is over, and prints a summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "trial.hpp"

namespace ductile::campaign {

struct Campaign {
  Settings settings;
  std::uint64_t seed = 1;
  double minutes = 1;
  std::uint64_t first = 0;           ///< number of the first case
  std::uint64_t count = UINT64_MAX;  ///< largest number of cases
  std::string kind;                  ///< only cases of this kind; all if empty
  std::filesystem::path folder;      ///< failing cases stay here
  int workers = 1;                   ///< processes side by side
  double restless_allowed = 0.05;    ///< share of the cases adapted three times
};

/// Runs the campaign and prints the result. Returns true if no trial failed.
bool run_campaign(const Campaign& campaign);

}  // namespace ductile::campaign
