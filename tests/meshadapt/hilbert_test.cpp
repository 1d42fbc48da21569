#include "mesh/hilbert.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "support/meshes.hpp"

namespace ductile::meshadapt {
namespace {

using Cell = std::array<std::uint32_t, 2>;

TEST(Hilbert, TheTableKnowsTheCurve) {
  test::Random random(1);
  for (int bits = 4; bits <= 24; bits += 4)
    for (int i = 0; i < 2000; ++i) {
      const Cell cell{static_cast<std::uint32_t>(random()) >> (32 - bits),
                      static_cast<std::uint32_t>(random()) >> (32 - bits)};
      EXPECT_EQ(hilbert_key(cell, bits), hilbert_key<2>(cell, bits));
    }
}

/// Of all cells of a square, each has its own place, and the next one is a neighbour.
TEST(Hilbert, GoesFromNeighbourToNeighbour) {
  constexpr std::uint32_t n = 16;
  std::array<Cell, n * n> at;
  at.fill({n, n});
  for (std::uint32_t x = 0; x < n; ++x)
    for (std::uint32_t y = 0; y < n; ++y) at[hilbert_key(Cell{x, y}, 4)] = {x, y};
  const auto apart = [](std::uint32_t a, std::uint32_t b) { return a < b ? b - a : a - b; };
  for (std::size_t i = 1; i < at.size(); ++i)
    EXPECT_EQ(apart(at[i - 1][0], at[i][0]) + apart(at[i - 1][1], at[i][1]), 1U);
}

}  // namespace
}  // namespace ductile::meshadapt
