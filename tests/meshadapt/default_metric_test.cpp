#include "ductile/meshadapt/default_metric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt {
namespace {

using runtime::Executor;

template <class Dimension>
class DefaultMetricIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(DefaultMetricIn, Dimensions, );

const Executor executor({.threads = 2});

TYPED_TEST(DefaultMetricIn, IsTheSizeAskedForEverywhere) {
  constexpr int Dim = TypeParam::value;
  const AnyField field = constant_metric(test::make_grid(test::unit_grid(Dim, 3)), 0.5);
  for (const Metric<Dim>& metric : tensors_of<Dim>(executor, field))
    EXPECT_EQ(metric, isotropic<Dim>(0.5));
}

TYPED_TEST(DefaultMetricIn, OfRegularElementsIsTheIdentity) {
  constexpr int Dim = TypeParam::value;
  AnyMesh one;
  one.dimension = Dim;
  one.vertex_reference.assign(Dim + 1, 0);
  if constexpr (Dim == 2) {
    one.coordinates = {0, 0, 1, 0, 0.5, std::sqrt(0.75)};
    one.triangles.add({0, 1, 2}, 1);
  } else {
    const double s = std::sqrt(0.5);
    one.coordinates = {0, 0, 0, s, s, 0, s, 0, s, 0, s, s};
    one.tetrahedra.add({0, 1, 2, 3}, 1);
  }
  for (const Metric<Dim>& metric : tensors_of<Dim>(executor, implied_tensors(executor, one)))
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j <= i; ++j) EXPECT_NEAR(metric(i, j), i == j ? 1 : 0, 1e-12);
}

TYPED_TEST(DefaultMetricIn, KeepsTheStretchOfTheMesh) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 8));
  for (std::size_t v = 0; v < any.vertex_count(); ++v) any.coordinates[v * Dim] *= 1e-3;
  const AnyField stretched = implied_tensors(executor, any), alike = implied_metric(any);
  EXPECT_EQ(measure(executor, any, &stretched).share_in_range(), 1);
  EXPECT_LT(measure(executor, any, &alike).share_in_range(), 0.5);
}

TYPED_TEST(DefaultMetricIn, RefusesLengthsBeyondReason) {
  AnyMesh any = test::make_grid(test::unit_grid(TypeParam::value, 1));
  for (double& x : any.coordinates) x *= 1e80;
  EXPECT_THROW(implied_metric(any), InputError);
}

TYPED_TEST(DefaultMetricIn, RefusesAMeshThatIsNotComplete) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(TypeParam::value, 2));
  AnyMesh bare = mesh;
  bare.vertex_reference.clear();
  try {
    implied_metric(bare);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("vertex_reference"), std::string::npos);
  }
  AnyMesh cut = mesh;
  cut.coordinates.pop_back();
  EXPECT_THROW(implied_metric(cut), InputError);
  AnyMesh wrong = mesh;
  elements_in<TypeParam::value>(wrong).vertices[1][1] = 1000000;
  EXPECT_THROW(implied_metric(wrong), InputError);
}

/// Rotated, so that what is thin is along no axis, and rounding shows.
TYPED_TEST(DefaultMetricIn, OfElementsAsFlatAsRoundingIsAMetric) {
  constexpr int Dim = TypeParam::value;
  for (const double thickness : {1e-6, 1e-8, 1e-10, 1e-13}) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, 4));
    for (std::size_t v = 0; v < any.vertex_count(); ++v) {
      double& x = any.coordinates[v * Dim];
      double& y = any.coordinates[v * Dim + 1];
      const double flat = thickness * y;
      y = 0.6 * x + 0.8 * flat;
      x = 0.8 * x - 0.6 * flat;
    }
    const AnyField implied = implied_tensors(executor, any);
    EXPECT_NO_THROW(metric_of(implied, any)) << thickness;
    for (const double value : implied.values) ASSERT_TRUE(std::isfinite(value)) << thickness;
  }
}

TYPED_TEST(DefaultMetricIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 40 : 9));
  test::Random random(2);
  test::jiggle(any, random, 0.3);
  const auto expected = implied_tensors(Executor({.threads = 1}), any).values;
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(expected, implied_tensors(Executor({.threads = threads}), any).values) << threads;
}

}  // namespace
}  // namespace ductile::meshadapt
