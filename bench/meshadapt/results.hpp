/// @file
/// Results: all that was measured, and the files that tell it: every sample as CSV, the tables that
/// plots.gp draws, and a page with tables and plots.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "copies.hpp"
#include "peer.hpp"
#include "sample.hpp"
#include "summary.hpp"

namespace ductile::bench {

struct Results {
  std::vector<Sample> samples;
  std::vector<CopiesRow> copies;
  std::vector<Pair> pairs;
  std::vector<std::string> notes;  ///< what was not measured, and why

  /// Whether every result is valid, and of each case and mode the same at all threads.
  bool sound() const;
};

/// Writes samples.csv, copies.csv, pairs.csv and the tables for plots into the
/// folder. Throws Error.
void write_tables(const Results& results, const std::filesystem::path& folder);

/// Writes report.html, with those plots that are there.
void write_page(const Results& results, const std::filesystem::path& folder);

// ---- The tables of the page ----

/// Seconds, speed, parallel efficiency, by case, threads and mode.
Table time_table(std::span<const Summary> summaries);
/// How many times as fast threads of one program are, beside what as many programs get done.
Table copies_table(std::span<const Summary> summaries, std::span<const CopiesRow> copies);
/// Elements, quality, memory, and whether bytes were the same.
Table mesh_table(std::span<const Summary> summaries);
/// Seconds of each part, in tiles.
Table part_table(std::span<const Summary> summaries);
/// Seconds of each phase of each kernel on the fewest threads.
Table phase_table(std::span<const Summary> summaries);
/// What the published method, by colours, takes, and each kernel's time over that of ours.
Table colours_table(std::span<const Summary> summaries);
/// Time per element of NAME@FACTOR beside NAME's.
Table growth_table(std::span<const Summary> summaries);
/// Medians of pairs, by case.
Table ratio_table(std::span<const Pair> pairs);

}  // namespace ductile::bench
