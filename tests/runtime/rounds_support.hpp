/// @file
/// Shared by the tests of run_rounds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace ductile::runtime::test {

using Vertex = std::uint32_t;
inline constexpr std::array thread_counts{1, 2, 3, 4, 8};

/// A reach() for plans that a test makes itself: grants everything.
struct ReachAny {
  bool operator()(Vertex) const { return true; }
};

inline std::vector<Vertex> all_items(std::size_t n) {
  std::vector<Vertex> items(n);
  std::iota(items.begin(), items.end(), 0U);
  return items;
}

}  // namespace ductile::runtime::test
