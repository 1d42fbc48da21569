/// @file
/// Summary: the median of the samples that were taken under the same conditions: same case, threads
/// and mode, and cores that lay as far apart before as after.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sample.hpp"

namespace ductile::bench {

struct Summary {
  std::string case_name;
  RunSettings settings;
  std::size_t taken = 0, used = 0;  ///< samples
  std::string placement;            ///< of the used ones; "moving" if no two looks agreed
  Sample
      median{};  ///< of each time and the memory for itself; the first's mesh, but valid if all are
  bool same_bytes = false;  ///< all samples, moving ones too
};

/// In the order in which the conditions first appear. Samples whose cores moved are left out, and
/// of the others those of the placement that was met most often are used; if all moved, all are.
std::vector<Summary> summarise(std::span<const Sample> samples);

/// The middle value, or the mean of the two in the middle; 0 of none.
double median(std::vector<double> values);

/// The summary of these conditions, or null.
const Summary* find(std::span<const Summary> summaries, const std::string& case_name,
                    const RunSettings& settings);

}  // namespace ductile::bench
