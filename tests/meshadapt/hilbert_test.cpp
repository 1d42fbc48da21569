#include "mesh/hilbert.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
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

/// Each cell of a square or cube has its own position, and the next cell is a neighbour.
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

/// Sanitizers report if a coordinate that is not finite is converted to an integer.
TYPED_TEST(Hilbert, EveryPointHasAKey) {
  constexpr int Dim = TypeParam::value;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Box<Dim> unit, narrow;  // narrow has no width at all
  for (Vector<Dim>* corner : {&unit.low, &narrow.low, &narrow.high}) corner->x.fill(0);
  unit.high.x.fill(1);
  const auto key = [](const Box<Dim>& box, double coordinate) {
    Vector<Dim> point;
    point.x.fill(coordinate);
    return hilbert_key<Dim>(point, box);
  };
  for (const double below : {nan, -infinite, -1e300, -1.})
    EXPECT_EQ(key(unit, below), key(unit, 0)) << below;
  for (const double above : {infinite, 1e300, 2.})
    EXPECT_EQ(key(unit, above), key(unit, 1)) << above;
  for (const double any : {nan, infinite, -infinite, 0., 1.})
    EXPECT_EQ(key(narrow, any), key(unit, any > 0 ? 1 : 0)) << any;
  for (const double bound : {nan, infinite, -infinite}) {
    unit.low.x[0] = bound;
    for (const double any : {nan, infinite, -infinite, 0., 1.}) key(unit, any);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::hilbert_test
