/// @file
/// Contests: for each subject, case and number of threads the candidates' medians, ordered, with
/// their ratios to the floor and to the best, and who may be called a winner.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "samples.hpp"

namespace ductile::bench::report {

/// How far apart two threads were, by the round trip of a cache line.
enum class Distance {
  unknown,    ///< not measured
  moved,      ///< not the same before and after the sample
  same_core,  ///< under 75 ns: two hyperthreads
  near,       ///< under 200 ns: one cache
  far,
};
Distance distance_of(const Sample& sample);
std::string words_for(Distance distance);

/// Fewer samples have no quartiles that say how far they are spread.
constexpr std::size_t enough_samples = 3;

/// One candidate in one contest.
struct Figure {
  std::string candidate;
  int threads = 1;                         ///< of its samples
  double median_ns = 0;                    ///< of the samples that count
  double low_ns = 0, high_ns = 0;          ///< their quartiles
  std::size_t samples = 0, left_out = 0;   ///< that count, that do not
  bool mixed = false;                      ///< none was at the usual distance, so all count
  std::map<std::string, double> counters;  ///< medians
  double over_best = 1;                    ///< ratio of medians
  std::optional<double> over_floor;        ///< nothing if there is no floor
  /// With the best: at most 3 % slower, or the lower quartile is not above the best's upper one.
  bool on_par = false;
  /// Its upper quartile is under the floor's lower one: either of them is wrong.
  bool below_floor = false;

  /// Whether its samples are enough to win.
  bool sound() const { return samples >= enough_samples && !mixed; }
};

struct Contest {
  std::string subject, case_name;
  int threads = 1;
  std::vector<Figure> figures;  ///< ascending median; never empty
  std::optional<Figure> floor;  ///< the fastest on at most this number of threads

  const Figure& best() const { return figures.front(); }
  /// Whether the best has enough samples; if not, no candidate is called the fastest.
  bool decided() const { return best().sound(); }
  /// Whether it is decided and nobody else is on a par with the best.
  bool clear() const;
};

struct Contests {
  std::vector<Contest> contests;       ///< by subject, threads, then case
  Distance usual = Distance::unknown;  ///< that most samples on several threads were taken at
};

/// Samples on several threads count if their threads were at the usual distance before and after. A
/// candidate measured on one thread only takes part at every number of threads: it is what a
/// program without threads would do. Thread safety: pure function.
Contests hold_contests(const std::vector<Sample>& samples);

}  // namespace ductile::bench::report
