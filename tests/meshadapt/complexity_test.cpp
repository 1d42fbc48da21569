#include "ductile/meshadapt/hessian_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::complexity_test {
namespace {

using runtime::Executor;
using test::Random;

template <class Dimension>
class ComplexityIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ComplexityIn, Dimensions, );

const Executor executor({.threads = 2});

template <int Dim>
struct Scene {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 6));
  FixedMesh<Dim> mesh = make_fixed_mesh<Dim>(executor, any);
  std::vector<Metric<Dim>> metric_of;

  Scene() {
    Random random(5);
    metric_of = tensors_of<Dim>(executor, test::wild_field(any, random, 20, 10));
  }
};

TYPED_TEST(ComplexityIn, IsWhatStatisticsSay) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  const AnyField field = symmetric_field<Dim>(executor, scene.metric_of, "f");
  const double expected = measure(executor, scene.any, &field).complexity;
  EXPECT_NEAR(complexity<Dim>(executor, scene.mesh, scene.metric_of), expected, 1e-9 * expected);
}

/// A mesh tells how many elements come per unit only if it is adapted to the metric, whatever the
/// scale of it.
TYPED_TEST(ComplexityIn, OfANumberOfElementsIsToldByAnAdaptedMesh) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene;
  const double constant = 1 / complexity_of_elements(Dim, 1);
  const MetricFit far =
      scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {.elements = 4000});
  EXPECT_TRUE(far.reached);
  EXPECT_NEAR(far.elements, 4000, 1e-3);
  EXPECT_NEAR(far.elements / far.complexity, constant, 1e-9);
  for (const double scale : {1e-3, 1.0, 7.0}) {
    std::vector<Metric<Dim>> own = tensors_of<Dim>(executor, constant_metric(scene.any, scale));
    const double elements = static_cast<double>(scene.mesh.element_count());
    const MetricFit near =
        scale_to_complexity<Dim>(executor, own, scene.mesh, {.elements = elements});
    EXPECT_NEAR(near.elements, elements, 1e-3 * elements);
    const double offset = near.elements / near.complexity - constant;
    EXPECT_EQ(std::abs(offset) > 0.01, Dim == 3) << offset;
  }
  EXPECT_THROW(scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {}), InputError);
  EXPECT_THROW(scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh,
                                        {.complexity = 1, .elements = 1}),
               InputError);
}

TYPED_TEST(ComplexityIn, IsReachedByScaling) {
  constexpr int Dim = TypeParam::value;
  for (const double wanted : {10.0, 12345.0}) {
    Scene<Dim> scene;
    const auto before = scene.metric_of;
    const MetricFit fit = scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {wanted});
    EXPECT_TRUE(fit.reached);
    EXPECT_NEAR(complexity<Dim>(executor, scene.mesh, scene.metric_of), wanted, 1e-6 * wanted);
    const double factor = scene.metric_of[0].m[0] / before[0].m[0];
    for (std::size_t v = 0; v < before.size(); ++v)
      EXPECT_NEAR(scene.metric_of[v].m[0] / before[v].m[0], factor, 1e-9 * factor);
  }
}

TYPED_TEST(ComplexityIn, IsReachedWithBoundsInForce) {
  constexpr int Dim = TypeParam::value;
  const SizeBounds bounds{.smallest = 0.03, .largest = 0.3, .anisotropy = 4};
  for (const double wanted : {Dim == 2 ? 30.0 : 120.0, Dim == 2 ? 700.0 : 15000.0}) {
    Scene<Dim> scene;
    const MetricFit fit =
        scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {wanted, bounds});
    EXPECT_TRUE(fit.reached);
    EXPECT_NEAR(complexity<Dim>(executor, scene.mesh, scene.metric_of), wanted, 1e-6 * wanted);
    for (const Metric<Dim>& metric : scene.metric_of) {
      const auto value = principal_axes(metric).value;
      const auto [low, high] = std::minmax_element(value.begin(), value.end());
      EXPECT_LE(*high, (1 + 1e-9) / (0.03 * 0.03));
      EXPECT_GE(*low, (1 - 1e-9) / (0.3 * 0.3));
      EXPECT_GE(*low, *high / 16 * (1 - 1e-9));
    }
  }
}

TYPED_TEST(ComplexityIn, BeyondTheBoundsIsNotReached) {
  constexpr int Dim = TypeParam::value;
  const SizeBounds bounds{.smallest = 0.1, .largest = 0.2};
  for (const double wanted : {1.0, 1e7}) {
    Scene<Dim> scene;
    const MetricFit fit =
        scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {wanted, bounds});
    EXPECT_FALSE(fit.reached);
    EXPECT_NEAR(fit.complexity, std::pow(wanted < 10 ? 5 : 10, Dim), 1e-6);
  }
}

TYPED_TEST(ComplexityIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  const auto run = [](int threads) {
    const Executor some({.threads = threads});
    Scene<Dim> scene;
    Random random(6);
    intersect<Dim>(some, scene.metric_of,
                   tensors_of<Dim>(some, test::wild_field(scene.any, random, 20, 10)));
    const MetricFit fit = scale_to_complexity<Dim>(
        some, scene.metric_of, scene.mesh,
        {.complexity = 500, .bounds = {.smallest = 0.01, .anisotropy = 5}, .gradation = 2});
    bound_sizes<Dim>(some, scene.metric_of, {.largest = 0.2});
    return std::tuple(fit.complexity, complexity<Dim>(some, scene.mesh, scene.metric_of),
                      scene.metric_of);
  };
  const auto expected = run(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(expected, run(threads)) << threads;
}

TYPED_TEST(ComplexityIn, RefusesWhatMakesNoSense) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene;
  for (const double wanted : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {wanted}),
                 InputError);
  for (const SizeBounds& bounds :
       {SizeBounds{.smallest = 2, .largest = 1}, SizeBounds{.anisotropy = 0.5}})
    EXPECT_THROW(scale_to_complexity<Dim>(executor, scene.metric_of, scene.mesh, {10, bounds}),
                 InputError);
  scene.metric_of.pop_back();
  EXPECT_THROW(complexity<Dim>(executor, scene.mesh, scene.metric_of), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::complexity_test
