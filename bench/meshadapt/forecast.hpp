/// @file
/// Forecast: what a case would need on more threads than there are, by a replay of what its loops
/// cost on one. It knows nothing of memory, so it is a bound on what can be hoped for.
#pragma once

#include <string>
#include <vector>

#include "sample.hpp"

namespace ductile::bench {

/// One number of threads.
struct ForecastRow {
  int threads = 1;
  PartSeconds seconds{};        ///< elapsed
  PartSeconds efficiency{};     ///< work over threads times elapsed; 0 where there is no work
  double serial_seconds = 0;    ///< between loops, on one thread
  double critical_seconds = 0;  ///< however many threads there are
};

struct Forecast {
  std::string case_name;
  std::uint64_t fingerprint = 0;    ///< of the recorded runs' result
  std::vector<ForecastRow> rows{};  ///< 1, 2, 4, ..., 64 threads
};

/// Records runs whose loops are cut for 8, 16 and 64 threads several times each, takes the least of
/// each cost and replays that on as many threads or fewer, with launches of 1 us + 30 ns a thread.
Forecast forecast(const Sampler& sampler, const std::string& case_name);

}  // namespace ductile::bench
