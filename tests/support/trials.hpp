/// @file
/// The number of random cases a test tries, DUCTILE_TRIALS, starting at DUCTILE_FIRST_TRIAL.
/// Sanitizers try few; a search for faults tries many. A test that takes long there says why it is
/// left out: `if (test::sanitized) GTEST_SKIP() << test::takes_long;`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace ductile::meshadapt::test {

#if defined(__has_feature)
#define DUCTILE_SANITIZED_BY(name) __has_feature(name##_sanitizer)
#else
#define DUCTILE_SANITIZED_BY(name) false
#endif
inline constexpr bool address_sanitized = DUCTILE_SANITIZED_BY(address);
inline constexpr bool sanitized = address_sanitized || DUCTILE_SANITIZED_BY(thread);
inline constexpr const char* takes_long =
    "takes long under a sanitizer, which runs the same code in smaller tests";
inline constexpr const char* compares_threads =
    "compares the results of several numbers of threads, which the release build runs";

inline std::uint64_t setting(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

inline std::uint64_t first_trial(std::uint64_t usual = 0) {
  return setting("DUCTILE_FIRST_TRIAL", usual);
}
inline std::uint64_t trials(std::uint64_t usual) {
  return setting("DUCTILE_TRIALS", sanitized ? std::min<std::uint64_t>(usual, 6) : usual);
}
inline std::uint64_t end_of_trials(std::uint64_t usual_count) {
  return first_trial() + trials(usual_count);
}

/// Numbers of threads that must give the bytes of one thread; two of them show races.
inline constexpr auto thread_counts = [] {
  if constexpr (sanitized)
    return std::array{2, 8};
  else
    return std::array{2, 3, 4, 8};
}();

}  // namespace ductile::meshadapt::test
