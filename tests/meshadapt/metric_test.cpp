#include "ductile/meshadapt/metric.hpp"

#include <gtest/gtest.h>

#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::metric_test {
namespace {

using test::difference;
using test::Random;
using test::uniform;

template <class Dimension>
class MetricIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MetricIn, Dimensions);

template <int Dim>
Metric<Dim> random_metric(Random& random, double anisotropy) {
  const double size = std::pow(10.0, uniform(random, -6, 6));
  std::array<double, Dim> sizes;
  for (double& h : sizes) h = size * std::pow(anisotropy, uniform(random, 0, 1));
  sizes[0] = size;
  sizes[Dim - 1] = size * anisotropy;
  return test::random_metric<Dim>(random, sizes);
}

TYPED_TEST(MetricIn, TheExponentialUndoesTheLogarithm) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (const double anisotropy : {1.0, 1.0001, 10.0, 1e3, 1e5})
    for (int trial = 0; trial < 200; ++trial) {
      const auto metric = random_metric<Dim>(random, anisotropy);
      EXPECT_LT(difference(metric, exponential(logarithm(metric))), 1e-12);
    }
}

/// Compares with the definition by eigenvalues, for tensors rotated a little or a lot, isotropic or
/// nearly so.
TYPED_TEST(MetricIn, TheExponentialIsThatOfTheEigenvalues) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    const double lowest = test::chance(random, 0.2) ? -170 : -18;  // subnormal squares
    const double spread = std::pow(10.0, uniform(random, lowest, 1));
    Metric<Dim> log_metric = uniform(random, -20, 20) * isotropic<Dim>(1);
    for (double& entry : log_metric.m)
      entry += test::chance(random, 0.2) ? 0 : spread * uniform(random, -1, 1);
    auto axes = principal_axes(log_metric);
    for (double& value : axes.value) value = std::exp(value);
    EXPECT_LT(difference(compose(axes), exponential(log_metric)), 1e-13) << spread;
  }
  EXPECT_EQ(exponential(Metric<Dim>{}), isotropic<Dim>(1));
}

/// At an anisotropy of 1e8 the entries of a rotated metric no longer determine its smallest
/// eigenvalue; those of an axis-parallel one do.
TYPED_TEST(MetricIn, TheLogarithmIsFiniteUpToTheLargestAnisotropy) {
  constexpr int Dim = TypeParam::value;
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    Metric<Dim> metric = isotropic<Dim>(1);
    metric.m[0] = 1e16;
    const auto again = exponential(logarithm(metric));
    EXPECT_LT(difference(metric, again), 1e-12);
    const auto turned = random_metric<Dim>(random, 1e7);
    for (const double m : exponential(logarithm(turned)).m) EXPECT_TRUE(std::isfinite(m));
  }
}

TYPED_TEST(MetricIn, EigenvectorsAreOrthonormalAndMakeTheMetricUp) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const auto metric = random_metric<Dim>(random, std::pow(10.0, uniform(random, 0, 6)));
    const auto axes = principal_axes(metric);
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        EXPECT_NEAR(dot(axes.vector[i], axes.vector[j]), i == j ? 1 : 0, 1e-14);
    EXPECT_LT(difference(metric, compose(axes)), 1e-13);
  }
}

TYPED_TEST(MetricIn, MeasuresLengths) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const auto metric = random_metric<Dim>(random, 100);
    Vector<Dim> d;
    for (double& x : d.x) x = uniform(random, -1, 1);
    EXPECT_NEAR(squared_length(metric, d) / dot(d, product(metric, d)), 1, 1e-12);
  }
  Vector<Dim> along;
  along[Dim - 1] = 3;
  EXPECT_DOUBLE_EQ(squared_length(isotropic<Dim>(1.5), along), 4);
}

TYPED_TEST(MetricIn, TheDeterminantKeepsItsDigitsInThinMetrics) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  for (const double anisotropy : {1.0, 1e2, 1e4, 1e5})
    for (int trial = 0; trial < 200; ++trial) {
      std::array<double, Dim> sizes;
      sizes.fill(anisotropy);
      sizes[0] = 1;
      const auto metric = test::random_metric<Dim>(random, sizes);
      const double expected = std::pow(anisotropy, -2.0 * (Dim - 1));
      EXPECT_NEAR(determinant(metric) / expected, 1, 1e-14 * anisotropy * anisotropy);
    }
}

/// The size varies geometrically from one end to the other: integrate its inverse.
double length_by_quadrature(double at_one_end, double at_other) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += at_one_end * std::pow(at_other / at_one_end, (i + 0.5) / steps);
  return sum / steps;
}

TEST(MeanLength, IsTheIntegralAlongTheEdge) {
  for (const double ratio : {1.0, 1.0 + 1e-9, 1.01, 1.0404, 1.05, 2.0, 30.0, 1e4})
    for (const double length : {1e-3, 1.0, 50.0}) {
      const double expected = length_by_quadrature(length, length * ratio);
      EXPECT_NEAR(mean_length(length, length * ratio) / expected, 1, 2e-7) << ratio;
      EXPECT_NEAR(mean_length(length * ratio, length) / expected, 1, 2e-7) << ratio;
    }
}

}  // namespace
}  // namespace ductile::meshadapt::metric_test
