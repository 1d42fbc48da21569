/// @file
/// Read before every source of a build that holds mutants: rules that are taken away one at a time.
/// The environment variable DUCTILE_MUTANT says which; without it nothing is taken away.
#pragma once

#include <cstdlib>

namespace ductile {

inline const int active_mutant = [] {
  const char* text = std::getenv("DUCTILE_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

/// Is the rule with this number taken away? Never in what the compiler evaluates.
constexpr bool is_mutant(int number) {
  return !__builtin_is_constant_evaluated() && number == active_mutant;
}

}  // namespace ductile
