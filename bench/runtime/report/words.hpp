/// @file
/// Words: what contests came to, in sentences, and times as people write them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contests.hpp"

namespace ductile::bench::report {

/// Three digits and a unit: "12.3 us".
std::string time_words(double ns);
/// Three digits: "1.07", "2.50 million"; two, where less than one: "0.87", "0.00012".
std::string ratio_words(double ratio);
/// How many samples count: "3", "1 of 3".
std::string samples_words(const Figure& figure);

/// Of one candidate, or of the best of one library, over several contests.
struct Standing {
  std::string who;
  std::vector<std::string> won;        ///< cases in which it was fastest, alone
  std::vector<std::string> on_par;     ///< cases in which it was fastest or on a par, and not alone
  std::vector<std::string> undecided;  ///< the fastest is one of these; too few samples say which
  std::size_t cases = 0;               ///< in which it took part
  double over_best = 1;                ///< geometric mean of its ratio to the best, over those
};

/// Whoever won most comes first. `who` of a candidate: itself, or its library.
enum class By { candidate, library };
std::vector<Standing> standings(std::span<const Contest> contests, By by);

/// What the contests of one subject and number of threads came to, a sentence each.
std::vector<std::string> sentences(std::span<const Contest> contests);

}  // namespace ductile::bench::report
