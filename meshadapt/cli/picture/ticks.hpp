/// @file
/// The numbers beside a scale.
#pragma once

#include <string>
#include <vector>

namespace ductile::cli {

/// A number beside a scale.
struct Tick {
  double at = 0;  ///< 0 to 1, along the scale
  std::string label;
};

/// Round numbers at their places on a scale that is even from `from` to `to`, about `most` of them;
/// one in the middle if both are the same.
std::vector<Tick> round_ticks(double from, double to, int most);

}  // namespace ductile::cli
