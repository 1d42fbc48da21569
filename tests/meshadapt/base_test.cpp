#include "operators/base.hpp"

#include <gtest/gtest.h>

#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::base_test {
namespace {

using test::Random;
using test::uniform;

template <int Dim>
Site<Dim> random_site(Random& random) {
  std::array<double, Dim> sizes;
  for (double& h : sizes) h = std::pow(10.0, uniform(random, -1, 1));
  Vector<Dim> p;
  for (int i = 0; i < Dim; ++i) p[i] = uniform(random, 0, 1);
  return make_site(p, test::random_metric<Dim>(random, sizes));
}

/// The corners of an element, of either orientation, and pointers to them.
template <int Dim>
struct RandomElement {
  std::array<Site<Dim>, Dim + 1> sites;
  std::array<const Site<Dim>*, Dim + 1> corners;

  explicit RandomElement(Random& random) {
    for (std::size_t i = 0; i <= Dim; ++i) {
      sites[i] = random_site<Dim>(random);
      corners[i] = &sites[i];
    }
  }
  RandomElement(const RandomElement&) = delete;
  RandomElement& operator=(const RandomElement&) = delete;
};

template <class Dimension>
class QualityOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(QualityOf, Dimensions);

TEST(Base, GivesTheQualityOfTheElementOnEitherSide) {
  Random random(21);
  for (int trial = 0; trial < 5000; ++trial) {
    RandomElement<3> made(random);
    auto& element = made.corners;
    const auto apex = static_cast<std::size_t>(trial % 4);
    std::array<const Site<3>*, 3> facet;
    for (std::size_t k = 0; k < 3; ++k)
      facet[k] = element[static_cast<std::size_t>(Simplex<3>::facet[apex][k])];
    const Base base = make_base(facet);
    const double side = quality<3>(element) > 0 ? 1 : -1;
    EXPECT_EQ(squared_quality_over(base, made.sites[apex], -side), -1);
    if (side < 0) std::swap(element[0], element[1]);
    EXPECT_NEAR(std::sqrt(squared_quality_over(base, made.sites[apex], side)), quality<3>(element),
                1e-12);
  }
}

TYPED_TEST(QualityOf, AgreesThatAQualityIsAboveABar) {
  constexpr int Dim = TypeParam::value;
  Random random(22);
  for (int trial = 0; trial < 5000; ++trial) {
    const RandomElement<Dim> made(random);
    const auto& element = made.corners;
    const double value = quality<Dim>(element);
    EXPECT_EQ(quality_above<Dim>(element, 0), value > 0);
    if (value <= 0) continue;
    EXPECT_TRUE(quality_above<Dim>(element, value * (1 - 1e-9)));
    EXPECT_FALSE(quality_above<Dim>(element, value * (1 + 1e-9)));
  }
}

}  // namespace
}  // namespace ductile::meshadapt::base_test
