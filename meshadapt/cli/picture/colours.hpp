/// @file
/// Colours of pictures: two scales from 0 to 1 and a list of distinct colours. All can be told
/// apart by people who do not see red and green as different.
#pragma once

#include <cstdint>

namespace ductile::cli {

struct Colour {
  double red = 0, green = 0, blue = 0;  ///< 0 to 1

  friend Colour operator*(double s, const Colour& c) {
    return {s * c.red, s * c.green, s * c.blue};
  }
  friend Colour operator+(const Colour& a, const Colour& b) {
    return {a.red + b.red, a.green + b.green, a.blue + b.blue};
  }
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Bad is red, good is blue (RdYlBu of ColorBrewer). Values outside [0, 1] get the end colours.
Colour quality_colour(double quality);

/// Small is dark violet, large is yellow (viridis of Matplotlib).
Colour size_colour(double fraction);

/// One of ten colours by the reference (Tableau 10, lightened).
Colour reference_colour(std::int32_t reference);

}  // namespace ductile::cli
