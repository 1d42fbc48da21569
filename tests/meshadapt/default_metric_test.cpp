#include "ductile/meshadapt/metric_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::default_metric_test {
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
  EXPECT_THROW(default_metric(executor, any), InputError);
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

/// The mesh is rotated, so that its thin direction is along no axis and rounding has an effect.
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

/// A grid with cells `aspect` times as wide as high, jiggled and rotated. Layers get thinner by the
/// factor `layers` each towards one side.
template <int Dim>
AnyMesh stretched_grid(test::Random& random, double aspect, double layers = 1) {
  const int n = Dim == 2 ? 16 : 5;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  test::jiggle(any, random, 0.2);
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    double& y = any.coordinates[v * Dim + Dim - 1];
    if (layers != 1) y = (std::pow(layers, n * y) - 1) / (std::pow(layers, n) - 1);
    y /= aspect;
  }
  test::place(any, random, std::pow(10, test::uniform(random, -3, 3)), 0);
  return any;
}

/// Adapts to the mesh's own metric; the number of elements may grow or shrink at most by the factor
/// `kept`.
template <int Dim>
void expect_kept(const AnyMesh& mesh, const AdaptOptions& options, double kept) {
  const AdaptedMesh adapted = adapt(executor, mesh, default_metric(executor, mesh), options);
  const auto before = static_cast<double>(elements_in<Dim>(mesh).size());
  const auto after = static_cast<double>(elements_in<Dim>(adapted.mesh).size());
  EXPECT_LT(after, kept * before);
  EXPECT_LT(before, kept * after);
  const MeshStatistics measured = measure(executor, adapted.mesh, &adapted.metric);
  EXPECT_GT(measured.share_in_range(), 0.9);
  EXPECT_NEAR(measured.edge_length.mean, 1, 0.1);
}

TYPED_TEST(DefaultMetricIn, KeepsStretchedMeshes) {
  test::Random random(11);
  for (int i = 0; i < 12; ++i) {
    const double aspect = std::pow(10, test::uniform(random, 1, 3));
    SCOPED_TRACE(aspect);
    expect_kept<TypeParam::value>(stretched_grid<TypeParam::value>(random, aspect), {}, 1.1);
  }
}

TYPED_TEST(DefaultMetricIn, KeepsLayers) {
  test::Random random(12);
  for (int i = 0; i < 12; ++i) {
    const double aspect = std::pow(10, test::uniform(random, 0, 2));
    const double layers = test::uniform(random, 1.05, TypeParam::value == 2 ? 1.4 : 2);
    SCOPED_TRACE(testing::Message() << aspect << ", layers " << layers);
    expect_kept<TypeParam::value>(stretched_grid<TypeParam::value>(random, aspect, layers), {},
                                  1.2);
  }
}

TYPED_TEST(DefaultMetricIn, KeepsStretchedMeshesWithinLimits) {
  constexpr int Dim = TypeParam::value;
  test::Random random(13);
  for (int i = 0; i < 6; ++i) {
    const AnyMesh mesh = stretched_grid<Dim>(random, std::pow(10, test::uniform(random, 1, 3)));
    const double lowest = measure(executor, mesh, nullptr).edge_length.min;
    expect_kept<Dim>(mesh, {.smallest_size = lowest / 10}, 1.1);
    expect_kept<Dim>(mesh, {.gradation = 3}, 1.6);
    const AdaptedMesh coarse =
        adapt(executor, mesh, default_metric(executor, mesh), {.smallest_size = 4 * lowest});
    EXPECT_LT(elements_in<Dim>(coarse.mesh).size(), elements_in<Dim>(mesh).size());
  }
}

/// Elements get better shapes, as in an isotropic metric, without an increase in number.
TYPED_TEST(DefaultMetricIn, IsIsotropicWhereTheMeshIs) {
  constexpr int Dim = TypeParam::value;
  test::Random random(14);
  for (int i = 0; i < 6; ++i) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 16 : 5));
    test::jiggle(any, random, test::uniform(random, 0.1, 0.4));
    test::place(any, random, 1, 0);
    const AnyMesh ours = adapt(executor, any, default_metric(executor, any)).mesh;
    const AnyMesh alike = adapt(executor, any, implied_metric(any)).mesh;
    const auto quality = [](const AnyMesh& mesh) {
      return measure(executor, mesh, nullptr).quality.mean;
    };
    EXPECT_GT(quality(ours), quality(alike) - 0.02);
    EXPECT_GE(quality(ours), quality(any) - 0.005);
    EXPECT_LT(elements_in<Dim>(ours).size(), 1.1 * elements_in<Dim>(any).size());
    EXPECT_GT(1.4 * elements_in<Dim>(ours).size(), elements_in<Dim>(any).size());
  }
}

/// Elements whose volume is lost to rounding are ignored.
TYPED_TEST(DefaultMetricIn, IsAMetricWhereElementsAreFlat) {
  constexpr int Dim = TypeParam::value;
  test::Random random(15);
  for (const double thickness : {1e-3, 1e-8, 1e-13, 1e-16}) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 8 : 4));
    test::make_slivers(any, random, 5, thickness);
    expect_kept<Dim>(any, {}, 1.6);
    const AnyField metric = default_metric(executor, any);
    EXPECT_NO_THROW(metric_of(metric, any)) << thickness;
  }
  AnyMesh flat = test::make_grid(test::unit_grid(Dim, 3));
  for (std::size_t v = 0; v < flat.vertex_count(); ++v) flat.coordinates[v * Dim] = 0;
  const AnyField metric = default_metric(executor, flat);
  EXPECT_NO_THROW(metric_of(metric, flat));
}

TYPED_TEST(DefaultMetricIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 40 : 9));
  test::Random random(2);
  test::jiggle(any, random, 0.3);
  const auto expected = implied_tensors(Executor({.threads = 1}), any).values;
  const auto ours = default_metric(Executor({.threads = 1}), any).values;
  for (const int threads : {2, 3, 8}) {
    EXPECT_EQ(expected, implied_tensors(Executor({.threads = threads}), any).values) << threads;
    EXPECT_EQ(ours, default_metric(Executor({.threads = threads}), any).values) << threads;
  }
}

}  // namespace
}  // namespace ductile::meshadapt::default_metric_test
