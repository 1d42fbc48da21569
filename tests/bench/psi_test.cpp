#include "cases/psi.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ductile::bench {
namespace {

/// Second differences of psi at a place away from the jump.
PsiHessian second_differences(double x, double y, double phase) {
  constexpr double h = 1e-4;
  const auto at = [&](int i, int j) { return psi(x + i * h, y + j * h, phase); };
  return {(at(1, 0) - 2 * at(0, 0) + at(-1, 0)) / (h * h),
          (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h * h),
          (at(0, 1) - 2 * at(0, 0) + at(0, -1)) / (h * h)};
}

TEST(Psi, HessianIsThatOfPsiBesideTheJump) {
  for (const double phase : {0.0, 1.7})
    for (const double x : {0.07, 0.31, 0.88})
      for (const double y : {0.12, 0.55, 0.97}) {
        ASSERT_GT(std::abs(psi_jump_level(x, y, phase)), 0.01);
        const PsiHessian exact = psi_hessian(x, y, phase), near = second_differences(x, y, phase);
        EXPECT_NEAR(exact.xx, near.xx, 0.02);
        EXPECT_NEAR(exact.xy, near.xy, 0.02);
        EXPECT_NEAR(exact.yy, near.yy, 0.02);
      }
}

TEST(Psi, JumpsByPiWhereItsLevelChangesSign) {
  constexpr double y = 0.1, near = 1e-9;
  const double x = std::sin(5 * y) / 2;
  EXPECT_NEAR(std::abs(psi(x + near, y, 0) - psi(x - near, y, 0)), 3.14159265, 1e-6);
}

}  // namespace
}  // namespace ductile::bench
