/// @file
/// Draws what the colours of a picture mean: a scale with numbers, or a list of references.
#pragma once

#include <cairo.h>

#include "scene.hpp"

namespace ductile::cli {

/// Where a legend goes: its upper left corner, how wide it may be, how large its letters are and
/// how wide its title may be.
struct LegendPlace {
  double x, y, width, text, room;
};

void draw_legend(cairo_t* pen, const Legend& legend, LegendPlace place);

}  // namespace ductile::cli
