#include "ductile/runtime/atomic_min.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::atomic_min_test {
namespace {

TEST(AtomicMin, SaysWhetherItLowered) {
  std::uint64_t word = 10;
  EXPECT_FALSE(atomic_min(word, 10));
  EXPECT_FALSE(atomic_min(word, 11));
  EXPECT_TRUE(atomic_min(word, 9));
  EXPECT_EQ(word, 9U);
}

TEST(AtomicMin, LowersShortWords) {
  std::uint32_t word = 10;
  EXPECT_FALSE(atomic_min(word, 10));
  EXPECT_TRUE(atomic_min(word, 9));
  EXPECT_EQ(word, 9U);
}

TEST(AtomicMin, KeepsTheLeastOfWhatManyThreadsOffer) {
  constexpr std::size_t words = 7, offers = 20000;
  std::vector<std::uint64_t> expected(words, ~std::uint64_t{0});
  for (std::size_t i = 0; i < offers; ++i)
    expected[i % words] = std::min(expected[i % words], mix64(i));
  for (int threads : {1, 2, 3, 4, 8}) {
    std::vector<std::uint64_t> least(words, ~std::uint64_t{0});
    parallel_for(Executor({.threads = threads}), offers,
                 [&](std::size_t i) { atomic_min(least[i % words], mix64(i)); });
    EXPECT_EQ(least, expected) << threads;
  }
}

}  // namespace
}  // namespace ductile::runtime::atomic_min_test
