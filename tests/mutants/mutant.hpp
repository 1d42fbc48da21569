/// @file
/// Included before every source of a build with mutants: rules that can be disabled one at a time.
/// The environment variable DUCTILE_MUTANT is the number of the disabled rule; without it none is.
/// If DUCTILE_REACHED names a file instead, the numbers of the rules that are evaluated are
/// appended to it.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>

namespace ductile {

/// No rule is disabled, but rules that are evaluated are recorded.
constexpr int note_reached = -1;

inline const char* const reached_file = std::getenv("DUCTILE_REACHED");

inline const int active_mutant = [] {
  if (reached_file != nullptr) return note_reached;
  const char* text = std::getenv("DUCTILE_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

inline bool reached[1000] = {};

/// Records a number when its rule is first evaluated, immediately, because a test may end a process
/// at any point. Returns false. Thread safety: any thread, and signal handlers.
inline bool note(int number) {
  if (__atomic_exchange_n(&reached[number], true, __ATOMIC_RELAXED)) return false;
  const int file = open(reached_file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  char line[] = {static_cast<char>('0' + number / 100), static_cast<char>('0' + number / 10 % 10),
                 static_cast<char>('0' + number % 10), '\n'};
  [[maybe_unused]] const auto written = write(file, line, sizeof line);
  close(file);
  return false;
}

/// Is the rule with this number disabled? Never in constant expressions.
constexpr bool is_mutant(int number) {
  if (__builtin_is_constant_evaluated()) return false;
  return active_mutant == note_reached ? note(number) : number == active_mutant;
}

}  // namespace ductile
