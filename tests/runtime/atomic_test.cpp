#include "ductile/runtime/atomic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::atomic_test {
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

TEST(NumberWithLock, KeepsItsNumberWhileItIsHeld) {
  NumberWithLock number;
  EXPECT_EQ(number.get(), 0U);
  number.set(7);
  {
    const auto held = number.hold();
    EXPECT_EQ(number.get(), 7U);
    number.set((1U << 31U) - 1);
    EXPECT_EQ(number.get(), (1U << 31U) - 1);
  }
  EXPECT_EQ(number.get(), (1U << 31U) - 1);
  const auto again = number.hold();
}

/// The locks guard plain counters, which lose counts if two threads change one at once.
TEST(NumberWithLock, LetsOneThreadInAtATime) {
  constexpr std::size_t turns = 20000;
  for (const int threads : test::thread_counts) {
    std::array<NumberWithLock, 3> locks;
    std::array<std::size_t, 3> counts{};
    parallel_for(Executor({.threads = threads}), turns,
                 [&](std::size_t i) {
                   const auto held = locks[i % 3].hold();
                   ++counts[i % 3];
                   locks[i % 3].set(locks[i % 3].get() + 2);
                 },
                 {.grain = 16});
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(counts[i], turns / 3 + (i < turns % 3)) << threads << " threads";
      EXPECT_EQ(locks[i].get(), 2 * counts[i]);
    }
  }
}

TEST(Lazy, IsMadeOnceHoweverManyThreadsAsk) {
  for (const int threads : {1, 2, 8}) {
    Lazy<std::vector<int>> lazy;
    EXPECT_EQ(lazy.made(), nullptr);
    std::atomic<int> makings = 0;
    std::vector<long> sum_of(5000);
    parallel_for(Executor({.threads = threads}), sum_of.size(), [&](std::size_t i) {
      const std::vector<int>& value = lazy.get([&] {
        ++makings;
        return std::vector<int>(100, 7);
      });
      sum_of[i] = std::accumulate(value.begin(), value.end(), 0L);
    });
    EXPECT_EQ(makings, 1);
    EXPECT_EQ(sum_of, std::vector<long>(sum_of.size(), 700));
    ASSERT_NE(lazy.made(), nullptr);
    EXPECT_EQ(lazy.made()->size(), 100U);
  }
}

TEST(Lazy, IsTriedAgainAfterAnException) {
  Lazy<int> lazy;
  EXPECT_THROW(lazy.get([]() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(lazy.made(), nullptr);
  EXPECT_EQ(lazy.get([] { return 3; }), 3);
  EXPECT_EQ(lazy.get([] { return 4; }), 3);
}

}  // namespace
}  // namespace ductile::runtime::atomic_test
