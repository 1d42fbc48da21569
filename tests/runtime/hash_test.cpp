#include "ductile/runtime/hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <unordered_set>

namespace ductile::runtime::hash_test {
namespace {

TEST(Hash, IsKnownWhenCompiling) {
  static_assert(mix32(0) == 0);
  static_assert(mix32(1) != mix32(2));
  static_assert(mix64(1) != mix64(2));
}

TEST(Hash, GivesDifferentIdsDifferentPriorities) {
  std::unordered_set<std::uint32_t> seen32;
  std::unordered_set<std::uint64_t> seen64;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    EXPECT_TRUE(seen32.insert(mix32(i)).second);
    EXPECT_TRUE(seen64.insert(mix64(i)).second);
  }
}

TEST(Hash, ChangesHalfTheBitsWhenOneChanges) {
  int changed32 = 0, changed64 = 0;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    changed32 += std::popcount(mix32(i) ^ mix32(i ^ (1U << (i % 32))));
    changed64 += std::popcount(mix64(i) ^ mix64(i ^ (std::uint64_t{1} << (i % 64))));
  }
  EXPECT_NEAR(changed32 / 4096.0, 16.0, 0.5);
  EXPECT_NEAR(changed64 / 4096.0, 32.0, 0.5);
}

}  // namespace
}  // namespace ductile::runtime::hash_test
