/// @file
/// Marks: how the candidates of a plot are told from each other. Each has a colour, which is its
/// library's in every plot, and a mark; no two candidates of a plot share both. Where the outlines
/// of one colour are used up, the mark is a number.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "contests.hpp"

namespace ductile::bench::report {

struct Style {
  std::string colour;
  std::size_t mark = 0;  ///< from outline_count on, a number is written
};

/// As many as gnuplot has.
constexpr std::size_t outline_count = 15;

/// Of each candidate of a section. `all` are the contests of the whole report. Libraries that meet
/// in a plot have different colours as long as there are enough. The marks of a plot differ, even
/// where colours do, as long as there are enough. Thread safety: pure function.
std::map<std::string, Style> styles(std::span<const Contest> section, std::span<const Contest> all);

/// A mark of about 9 points at a place in gnuplot's coordinates, as a command of gnuplot.
std::string label(const Style& style, const std::string& place);

}  // namespace ductile::bench::report
