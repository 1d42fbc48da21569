/// @file
/// Colours and text for drawing with cairo.
#pragma once

#include <cairo.h>

#include <string>

#include "colours.hpp"

namespace ductile::cli {

inline void set_colour(cairo_t* pen, const Colour& colour, double alpha = 1) {
  cairo_set_source_rgba(pen, colour.red, colour.green, colour.blue, alpha);
}

inline double text_width(cairo_t* pen, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(pen, text.c_str(), &extents);
  return extents.x_advance;
}

/// Writes the text from x - share_left times its width.
inline void write(cairo_t* pen, double x, double y, const std::string& text,
                  double share_left = 0) {
  cairo_move_to(pen, x - share_left * text_width(pen, text), y);
  cairo_show_text(pen, text.c_str());
}

}  // namespace ductile::cli
