/// @file
/// page: the report as HTML: what is doubtful of it; who won where, in words; for each subject and
/// number of threads a plot, a table of all candidates in all cases, and below that a table for
/// each case; then the machine and what was not measured.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contests.hpp"
#include "report/page.hpp"

namespace ductile::bench::report {

/// Contests of one subject and number of threads.
using Section = std::span<const Contest>;
std::vector<Section> sections(const Contests& contests);

/// The name of a section's plot, which the page expects beside it.
std::string plot_file(const Section& section);

/// Thread safety: pure function.
Page page(const Samples& samples, const Contests& contests);

}  // namespace ductile::bench::report
