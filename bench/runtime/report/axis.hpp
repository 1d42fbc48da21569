/// @file
/// Axis: the logarithmic axis of a plot, from a tick to a tick. It has room for what is compared,
/// not for what is far from all else: one ratio of a million would squeeze all others together.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contests.hpp"

namespace ductile::bench::report {

/// What a plot shows: the ratio to the floor; to the best, where there is no floor.
double ratio_of(const Figure& figure);

class Axis {
 public:
  /// How far it goes at most, up and down from where the best of most cases is.
  static constexpr double up = 100, down = 10;

  /// At least one contest.
  explicit Axis(std::span<const Contest> contests);

  /// 1, 2 and 5 times powers of ten, ascending; the first and the last are its ends.
  const std::vector<double>& ticks() const { return ticks_; }
  bool is_below(double ratio) const { return ratio < ticks_.front(); }
  bool is_beyond(double ratio) const { return ratio > ticks_.back(); }

 private:
  std::vector<double> ticks_;
};

}  // namespace ductile::bench::report
