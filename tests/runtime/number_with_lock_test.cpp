#include "ductile/runtime/number_with_lock.hpp"

#include <gtest/gtest.h>

#include <array>

#include "ductile/runtime/parallel_for.hpp"
#include "rounds_support.hpp"

namespace ductile::runtime::number_with_lock_test {
namespace {

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

/// Plain counters beside the locks: one that two threads change at once loses counts.
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

}  // namespace
}  // namespace ductile::runtime::number_with_lock_test
