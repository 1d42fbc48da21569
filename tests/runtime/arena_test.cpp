#include "ductile/runtime/arena.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::arena_test {
namespace {

using SmallArena = Arena<std::uint32_t, 12>;  // short segments, to cross many borders

/// Allocates arrays of many lengths on many threads; true if no two of them overlap.
bool arrays_keep_their_contents(SmallArena& arena, int threads) {
  constexpr std::uint32_t arrays = 2000;
  std::vector<std::uint32_t> index(arrays);
  const auto length = [](std::uint32_t a) { return mix32(a) % (a % 100 == 0 ? 30000U : 200U); };
  const Executor executor({.threads = threads});
  parallel_for(executor, arrays, [&](std::size_t i) {
    const auto a = static_cast<std::uint32_t>(i);
    index[a] = arena.allocate(length(a));
    for (std::uint32_t k = 0; k < length(a); ++k) arena.at(index[a])[k] = mix32(a + k);
  });
  for (std::uint32_t a = 0; a < arrays; ++a)
    for (std::uint32_t k = 0; k < length(a); ++k)
      if (*arena.at(index[a] + k) != mix32(a + k) ||
          arena.at(index[a] + k) != arena.at(index[a]) + k)
        return false;
  return true;
}

TEST(Arena, KeepsArraysApartOnManyThreadsAndAfterClear) {
  for (int threads : {1, 2, 3, 4, 8}) {
    SmallArena arena;
    EXPECT_TRUE(arrays_keep_their_contents(arena, threads)) << threads;
    arena.clear();
    EXPECT_EQ(arena.allocate(0), 0U);
    EXPECT_TRUE(arrays_keep_their_contents(arena, threads)) << threads;
  }
}

TEST(Arena, ReturnsItsMemoryByAllThreadsAndServesAgain) {
  for (const int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    SmallArena arena;
    arena.release(executor);
    for (int turn = 0; turn < 2; ++turn) {
      EXPECT_TRUE(arrays_keep_their_contents(arena, threads)) << threads;
      arena.release(executor);
      EXPECT_EQ(arena.allocate(0), 0U);
    }
  }
}

TEST(Arena, StopsAtTheEndOfItsIndices) {
  Arena<std::uint8_t, 28> arena;
  EXPECT_THROW(
      {
        for (int i = 0; i < 20; ++i) arena.allocate(1U << 28U);
      },
      std::length_error);
}

}  // namespace
}  // namespace ductile::runtime::arena_test
