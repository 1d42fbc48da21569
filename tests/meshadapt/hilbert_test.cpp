#include "mesh/hilbert.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "support/meshes.hpp"

namespace ductile::meshadapt::hilbert_test {
namespace {

template <class Dimension>
class Hilbert : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Hilbert, Dimensions);

TYPED_TEST(Hilbert, TheTableKnowsTheCurve) {
  constexpr int Dim = TypeParam::value, step = HilbertTable<Dim>::step;
  test::Random random(1);
  for (int bits = step; bits <= 20; bits += step)
    for (int i = 0; i < 2000; ++i) {
      std::array<std::uint32_t, Dim> cell;
      for (auto& x : cell) x = static_cast<std::uint32_t>(random()) >> (32 - bits);
      EXPECT_EQ(hilbert_key_by_table<Dim>(cell, bits), runtime::hilbert_key<Dim>(cell, bits));
    }
}

/// Of all cells of a square or cube, each has its own place, and the next one is a neighbour.
TYPED_TEST(Hilbert, GoesFromNeighbourToNeighbour) {
  constexpr int Dim = TypeParam::value, bits = 4;
  using Cell = std::array<std::uint32_t, Dim>;
  std::array<Cell, std::size_t{1} << (Dim * bits)> at;
  at.fill({1U << bits});
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    Cell cell;
    for (unsigned axis = 0; axis < Dim; ++axis) cell[axis] = i >> (axis * bits) & 15U;
    at[hilbert_key_by_table<Dim>(cell, bits)] = cell;
  }
  for (std::size_t i = 1; i < at.size(); ++i) {
    std::uint32_t apart = 0;
    for (std::size_t axis = 0; axis < Dim; ++axis)
      apart += std::max(at[i][axis], at[i - 1][axis]) - std::min(at[i][axis], at[i - 1][axis]);
    EXPECT_EQ(apart, 1U);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::hilbert_test
