/// @file
/// The extent of a run, its numbers of threads, and the main function of every benchmark program.
/// Environment variables set them, so that one command can drive many programs: DUCTILE_BENCH is
/// `quick`, `standard` (the default) or `full`; DUCTILE_BENCH_THREADS lists numbers of threads, "1
/// 2 4"; by default they double up to the cores of the machine.
#pragma once

#include <vector>

namespace ductile::bench {

enum class Extent {
  quick,     ///< tiny sizes: does everything work?
  standard,  ///< representative sizes: minutes
  full,      ///< the whole grid: hours, and some gigabytes
};

/// Throws std::runtime_error for an unknown DUCTILE_BENCH. Thread safety: while nobody changes the
/// environment.
Extent extent();

/// One of three values, by the extent of this run.
template <class T>
T by_extent(T quick, T standard, T full) {
  const Extent e = extent();
  return e == Extent::quick ? quick : e == Extent::standard ? standard : full;
}

/// Ascending numbers of threads, from 1 unless the environment says otherwise. Throws
/// std::runtime_error if that has no list of positive numbers. Thread safety: as extent().
std::vector<int> thread_counts();

/// The numbers of threads above 1; 1 if there are none.
std::vector<int> team_sizes();

/// The main function of a program that registers its benchmarks in `add_all`: Google Benchmark's
/// options, an exit code, and a message on stderr instead of an exception.
int run(int argc, char** argv, void (*add_all)());

}  // namespace ductile::bench
