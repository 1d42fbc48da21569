/// @file
/// Draws what the colours of a picture mean: a scale with numbers, or a list of references.
#pragma once

#include <cairo.h>

#include "scene.hpp"

namespace ductile::cli {

/// The place of a legend: its upper left corner, its width, the size of its letters and the width
/// of its title.
struct LegendPlace {
  double x, y, width, text, room;
};

/// The colour at a share from 0 to 1 of a scale.
Colour scale_colour(const Legend& legend, double share);

void draw_legend(cairo_t* pen, const Legend& legend, LegendPlace place);

}  // namespace ductile::cli
