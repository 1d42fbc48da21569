/// @file
/// Runs programs of PBBS and Galois on the same inputs, if they are on the PATH. Only the times
/// that they print themselves are used; these exclude reading and writing files.
#pragma once

#include <string>
#include <vector>

#include "report.hpp"
#include "suite.hpp"

namespace ductile::bench::irregular {

/// Medians for all programs of this algorithm that are found and can read the input. Seconds are
/// negative if a program failed or printed no time.
std::vector<Measurement> measure_peers(const std::string& algorithm, const Problem& problem,
                                       const std::vector<int>& thread_counts, int repetitions);

}  // namespace ductile::bench::irregular
