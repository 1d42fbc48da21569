/// @file
/// Copies: what a machine gives to several programs that have nothing to do with each other. The
/// threads of one program have about as much.
#pragma once

#include <functional>
#include <string>

namespace ductile::bench {

/// How many times as much so many copies of a program, of one thread each, get done as one alone.
struct CopiesRow {
  std::string case_name;
  int copies = 1;
  double speed = 1;
};

/// Runs `work`, which starts no threads and returns its seconds, in a process alone and in so many
/// at once, three times in turns, and compares medians. Throws std::runtime_error if the system
/// refuses a process or the work fails in one. Thread safety: one caller, nothing else running.
double speed_of_copies(const std::function<double()>& work, int copies);

}  // namespace ductile::bench
