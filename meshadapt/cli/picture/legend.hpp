/// @file
/// Colours and text for drawing with cairo, and what the colours of a picture mean: a scale with
/// numbers, or a list of references.
#pragma once

#include <cairo.h>

#include <string>

#include "scene.hpp"

namespace ductile::cli {

inline void set_colour(cairo_t* pen, const Colour& colour, double alpha = 1) {
  cairo_set_source_rgba(pen, colour.red, colour.green, colour.blue, alpha);
}

inline double text_width(cairo_t* pen, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(pen, text.c_str(), &extents);
  return extents.x_advance;
}

inline void write(cairo_t* pen, double x, double y, const std::string& text) {
  cairo_move_to(pen, x, y);
  cairo_show_text(pen, text.c_str());
}

/// The place of a legend: its upper left corner, its width, the size of its letters and the width
/// of its title.
struct LegendPlace {
  double x, y, width, text, room;
};

/// The colour at a share from 0 to 1 of a scale.
Colour scale_colour(const Legend& legend, double share);

void draw_legend(cairo_t* pen, const Legend& legend, LegendPlace place);

}  // namespace ductile::cli
