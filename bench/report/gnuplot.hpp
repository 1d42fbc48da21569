/// @file
/// draw_plots: pictures of figures. All that benchmarks and experiments plot is a script of
/// gnuplot, written by hand beside them (plots.gp) or by their report, and is drawn from here.
#pragma once

#include <filesystem>
#include <string>

namespace ductile::bench {

/// Runs a script in the folder that has the tables and gets the pictures. What gnuplot says goes to
/// the standard error. False if it is not on the PATH, or fails; some pictures may be there then.
bool draw_plots(const std::filesystem::path& script, const std::filesystem::path& folder);

/// What a report says then.
inline constexpr const char* no_plots =
    "Some plots are missing, because gnuplot is not on the PATH, or failed.";

/// A text as a script of gnuplot has it, in quotes.
std::string quoted(const std::string& text);

}  // namespace ductile::bench
