/// @file
/// The number of random cases a test tries, DUCTILE_TRIALS, starting at DUCTILE_FIRST_TRIAL.
/// Sanitizers try few; a search for faults tries many.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace ductile::meshadapt::test {

inline std::uint64_t setting(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

inline std::uint64_t first_trial(std::uint64_t usual = 0) {
  return setting("DUCTILE_FIRST_TRIAL", usual);
}
inline std::uint64_t trials(std::uint64_t usual) { return setting("DUCTILE_TRIALS", usual); }
inline std::uint64_t end_of_trials(std::uint64_t usual_count) {
  return first_trial() + trials(usual_count);
}

}  // namespace ductile::meshadapt::test
