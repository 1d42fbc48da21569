/// @file
/// Busy work of a given duration.
#pragma once

#include <chrono>

namespace ductile::runtime::test {

inline void spin(std::chrono::nanoseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
  }
}

}  // namespace ductile::runtime::test
