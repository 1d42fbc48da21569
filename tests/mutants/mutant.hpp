/// @file
/// Read before every source of a build that holds mutants: rules that are taken away one at a time.
/// The environment variable DUCTILE_MUTANT says which; without it nothing is taken away. If
/// DUCTILE_REACHED names a file instead, the numbers of the rules that are asked are added to it.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>

namespace ductile {

/// Nothing is taken away, the rules that are asked are noted.
constexpr int note_reached = -1;

inline const char* const reached_file = std::getenv("DUCTILE_REACHED");

inline const int active_mutant = [] {
  if (reached_file != nullptr) return note_reached;
  const char* text = std::getenv("DUCTILE_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

inline bool reached[1000] = {};

/// Writes a number the first time that a rule is asked, at once, because a test may end a process
/// at any place. Returns false. Thread safety: any thread, and handlers of signals.
inline bool note(int number) {
  if (__atomic_exchange_n(&reached[number], true, __ATOMIC_RELAXED)) return false;
  const int file = open(reached_file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  char line[] = {static_cast<char>('0' + number / 100), static_cast<char>('0' + number / 10 % 10),
                 static_cast<char>('0' + number % 10), '\n'};
  [[maybe_unused]] const auto written = write(file, line, sizeof line);
  close(file);
  return false;
}

/// Is the rule with this number taken away? Never in what the compiler evaluates.
constexpr bool is_mutant(int number) {
  if (__builtin_is_constant_evaluated()) return false;
  return active_mutant == note_reached ? note(number) : number == active_mutant;
}

}  // namespace ductile
