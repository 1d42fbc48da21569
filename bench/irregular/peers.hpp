/// @file
/// Programs of PBBS and Galois on the same inputs, if they are on the PATH. What counts is the time
/// that they print themselves, without reading and writing files.
#pragma once

#include <string>
#include <vector>

#include "report.hpp"
#include "suite.hpp"

namespace ductile::bench::irregular {

/// Medians of all programs for this algorithm that are found and can read the input; seconds are a
/// number below 0 for one that failed or printed no time.
std::vector<Measurement> measure_peers(const std::string& algorithm, const Problem& problem,
                                       const std::vector<int>& thread_counts, int repetitions);

}  // namespace ductile::bench::irregular
