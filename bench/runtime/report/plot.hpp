/// @file
/// plot: the contests of one subject and number of threads as a picture that gnuplot draws: a row
/// for each case, a mark for each candidate at the ratio of its median to the floor (to the best,
/// where there is no floor). A library has a colour, a candidate a mark (marks.hpp). What the axis
/// has no room for (axis.hpp) stands at its edge, with its ratio in words.
#pragma once

#include <span>
#include <string>

#include "contests.hpp"

namespace ductile::bench::report {

/// A script that writes the picture to a file of this name. `contests` are those of one subject and
/// number of threads, at least one; `all` those of the whole report, which decide the colours.
/// Beside each mark a comment says which candidate it is, and its median. Thread safety: pure
/// function.
std::string plot(const std::string& file, std::span<const Contest> contests,
                 std::span<const Contest> all);

}  // namespace ductile::bench::report
