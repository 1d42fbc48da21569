/// @file
/// Marks: how the candidates of a plot are told from each other. Each has a colour, which is its
/// library's in every plot, and a mark; no two candidates of a plot share both. Where the outlines
/// of one colour are used up, the mark is a number.
#pragma once

#include <cstddef>
#include <map>
#include <ostream>
#include <span>
#include <string>

#include "contests.hpp"

namespace ductile::bench::report {

struct Style {
  std::string colour;
  std::size_t mark = 0;  ///< from outline_count on, a number is written
};

/// Eight outlines, filled and hollow.
constexpr std::size_t outline_count = 16;

/// Of each candidate of a section. `all` are the contests of the whole report. Libraries that meet
/// in a plot have different colours as long as there are enough. The marks of a plot differ, even
/// where colours do, as long as there are enough. Thread safety: pure function.
std::map<std::string, Style> styles(std::span<const Contest> section, std::span<const Contest> all);

struct Point {
  double x = 0, y = 0;
};

/// A mark of about 9 points as SVG; `says` is what a browser shows beside the pointer.
void draw_mark(std::ostream& to, const Style& style, Point at, const std::string& says);

}  // namespace ductile::bench::report
