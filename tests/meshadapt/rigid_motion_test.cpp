#include "move/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "move_support.hpp"
#include "support/broken_input.hpp"

namespace ductile::meshadapt::move_test {
namespace {

using test::Random;
using test::uniform;

template <class Dimension>
class RigidMotionIn : public testing::Test {};
TYPED_TEST_SUITE(RigidMotionIn, test::Dimensions, );

TYPED_TEST(RigidMotionIn, IsFound) {
  constexpr int Dim = TypeParam::value;
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    RigidMotion<Dim> wanted;
    for (int i = 0; i < Dim; ++i) {
      wanted.pivot[i] = uniform(random, -1, 1);
      wanted.shift[i] = uniform(random, -1, 1);
    }
    Rotation<Dim>& rotation = wanted.rotation;
    rotation.angle = uniform(random, 0.01, 3.1) * (Dim == 2 && trial % 2 ? -1 : 1);
    if (Dim == 3)
      for (int i = 0; i < 3; ++i) rotation.axis[i] = uniform(random, -1, 1);
    rotation.axis *= 1 / norm(rotation.axis);
    std::vector<Vector<Dim>> from, to;
    const bool is_flat = trial % 5 == 0;
    for (int p = 0; p < 20; ++p) {
      Vector<Dim> point;
      for (int i = 0; i < Dim; ++i) point[i] = is_flat && i == Dim - 1 ? 0 : uniform(random, 0, 1);
      from.push_back(point);
      to.push_back(wanted.moved(point, 1));
    }
    const auto found = closest_motion(from, to);
    for (std::size_t p = 0; p < from.size(); ++p)
      EXPECT_LT(norm(found.moved(from[p], 1) - to[p]), 1e-12) << trial;
    EXPECT_NEAR(std::abs(found.rotation.angle), std::abs(rotation.angle), 1e-9) << trial;
  }
}

/// A stretch along any axes has no influence on the rotation of a deformation.
TYPED_TEST(RigidMotionIn, APolarDecompositionFindsTheRotation) {
  constexpr int Dim = TypeParam::value;
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const auto rotation = [&](double most) {
      Rotation<Dim> result{uniform(random, 0.01, most), {{0, 0, 1}}};
      if (Dim == 3)
        for (int i = 0; i < 3; ++i) result.axis[i] = uniform(random, -1, 1);
      result.axis *= 1 / norm(result.axis);
      return result;
    };
    const Rotation<Dim> wanted = rotation(3.1), axes = rotation(3);
    const Rotation<Dim> back{-axes.angle, axes.axis};
    Vector<Dim> stretch;
    for (int i = 0; i < Dim; ++i) stretch[i] = uniform(random, 0.2, 5);
    std::array<Vector<Dim>, Dim + 1> from, to;
    for (std::size_t corner = 0; corner <= Dim; ++corner) {
      for (int i = 0; i < Dim; ++i) from[corner][i] = uniform(random, 0, 0.2);
      if (corner > 0) from[corner].x[corner - 1] += 1;
      Vector<Dim> point = back.turned(from[corner]);
      for (int i = 0; i < Dim; ++i) point[i] *= stretch[i];
      to[corner] = wanted.turned(axes.turned(point));
    }
    const Rotation<Dim> found = rotation_of(deformation<Dim>(from, to));
    for (const Vector<Dim>& point : from)
      EXPECT_LT(norm(found.turned(point) - wanted.turned(point)), 1e-10) << trial;
  }
}

TEST(RigidMotion, OfAFlapKeepsItsHinge) {
  const Motion<2> flap = turn(80, {{0.2, 0.5}});
  std::vector<Vector<2>> from, to;
  for (int i = 0; i <= 10; ++i)
    for (const double y : {0.49, 0.51}) from.push_back({{0.2 + 0.05 * i, y}});
  for (const auto& point : from) to.push_back(flap(point));
  const auto found = closest_motion(from, to);
  for (const double share : {0.25, 0.5, 1.0})
    EXPECT_LT(norm(found.moved({{0.2, 0.5}}, share) - Vector<2>{{0.2, 0.5}}), 1e-12);
}

}  // namespace
}  // namespace ductile::meshadapt::move_test
