#include "ductile/meshadapt/hessian_metric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::hessian_metric_test {
namespace {

using runtime::Executor;
using test::Random;
using test::uniform;

template <class Dimension>
class HessianMetricIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(HessianMetricIn, Dimensions, );

const Executor executor({.threads = 2});
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Indefinite tensors with curvatures that differ by up to 100 times.
template <int Dim>
struct Scene {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 12 : 6));
  FixedMesh<Dim> mesh = make_fixed_mesh<Dim>(executor, any);
  std::vector<Metric<Dim>> hessian_of, absolute_of;

  Scene() {
    Random random(6);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      std::array<double, Dim> sizes;
      for (double& h : sizes) h = uniform(random, 0.1, 1);
      absolute_of.push_back(test::random_metric<Dim>(random, sizes));
      PrincipalAxes<Dim> axes = principal_axes(absolute_of.back());
      for (double& value : axes.value)
        if (test::chance(random, 0.5)) value = -value;
      hessian_of.push_back(compose(axes));
    }
  }
};

template <int Dim>
double difference(const Metric<Dim>& a, const Metric<Dim>& b) {
  double most = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j)
      most = std::max(most, std::abs(a(i, j) - b(i, j)) / std::sqrt(b(i, i) * b(j, j)));
  return most;
}

TYPED_TEST(HessianMetricIn, IsTheFormulaOfLoseilleAndAlauzet) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  const double wanted = 500;
  for (const double norm : {1.0, 2.0, 4.0, infinity}) {
    // N^(2/d) (integral of det|H|^(p/(2p+d)))^(-2/d) det|H|^(-1/(2p+d)) |H|
    const double power = std::isinf(norm) ? 0.5 : norm / (2 * norm + Dim);
    double integral = 0;
    for (std::size_t v = 0; v < scene.mesh.vertex_count(); ++v)
      integral += scene.mesh.share_of[v] * std::pow(determinant(scene.absolute_of[v]), power);
    const auto result = hessian_metric<Dim>(executor, scene.mesh, scene.hessian_of,
                                            {.norm = norm, .complexity = wanted});
    for (std::size_t v = 0; v < scene.mesh.vertex_count(); ++v) {
      const double factor = std::pow(wanted / integral, 2.0 / Dim) *
                            std::pow(determinant(scene.absolute_of[v]), -1 / (2 * norm + Dim));
      EXPECT_LT(difference(result.metric_of[v], factor * scene.absolute_of[v]), 1e-7);
    }
    EXPECT_TRUE(result.fit.reached);
    EXPECT_NEAR(result.fit.complexity, wanted, 1e-5);
    if (std::isinf(norm)) continue;
    const double error = Dim / (4.0 * (Dim + 2)) * std::pow(wanted, -2.0 / Dim) *
                         std::pow(integral, (2 * norm + Dim) / (Dim * norm));
    EXPECT_NEAR(result.fit.error, error, 1e-7 * error);
  }
}

TYPED_TEST(HessianMetricIn, ReachesAnError) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  for (const double norm : {1.0, 2.0, infinity}) {
    const auto result =
        hessian_metric<Dim>(executor, scene.mesh, scene.hessian_of, {.norm = norm, .error = 0.01});
    EXPECT_TRUE(result.fit.reached);
    EXPECT_NEAR(result.fit.error, 0.01, 1e-8);
  }
}

TYPED_TEST(HessianMetricIn, KeepsToBoundsAndReachesTheComplexityAllTheSame) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  const double wanted = Dim == 2 ? 800 : 10000;
  const auto result = hessian_metric<Dim>(
      executor, scene.mesh, scene.hessian_of,
      {.complexity = wanted, .bounds = {.smallest = 0.02, .largest = 0.08, .anisotropy = 2}});
  EXPECT_TRUE(result.fit.reached);
  EXPECT_NEAR(complexity<Dim>(executor, scene.mesh, result.metric_of), wanted, 1e-6 * wanted);
  for (const Metric<Dim>& metric : result.metric_of) {
    const auto value = principal_axes(metric).value;
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    EXPECT_LE(*high, (1 + 1e-9) / (0.02 * 0.02));
    EXPECT_GE(*low, (1 - 1e-9) / (0.08 * 0.08));
    EXPECT_GE(*low, *high / 4 * (1 - 1e-9));
  }
}

TYPED_TEST(HessianMetricIn, IsUniformForAFunctionWithoutCurvature) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  const std::vector<Metric<Dim>> nothing(scene.mesh.vertex_count());
  const auto result = hessian_metric<Dim>(executor, scene.mesh, nothing, {.complexity = 1000});
  EXPECT_TRUE(result.fit.reached);
  EXPECT_EQ(result.fit.error, 0);
  for (const Metric<Dim>& metric : result.metric_of)
    EXPECT_LT(difference(metric, isotropic<Dim>(std::pow(1000, -1.0 / Dim))), 1e-7);
  const auto coarsest = hessian_metric<Dim>(executor, scene.mesh, nothing, {.error = 1e-3});
  EXPECT_TRUE(coarsest.fit.reached);
  EXPECT_LT(difference(coarsest.metric_of[0], isotropic<Dim>(std::sqrt(Dim))), 1e-7);
}

TYPED_TEST(HessianMetricIn, RefusesWhatMakesNoSense) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene;
  const auto fit = [&](const HessianMetricOptions& options) {
    hessian_metric<Dim>(executor, scene.mesh, scene.hessian_of, options);
  };
  EXPECT_THROW(fit({}), InputError);
  EXPECT_THROW(fit({.complexity = 10, .error = 0.1}), InputError);
  EXPECT_THROW(fit({.complexity = -1}), InputError);
  EXPECT_THROW(fit({.norm = 0.5, .complexity = 10}), InputError);
  EXPECT_THROW(fit({.complexity = 10, .bounds = {.smallest = 2, .largest = 1}}), InputError);
  for (std::size_t v = 7; v < scene.hessian_of.size(); ++v) scene.hessian_of[v].m[0] = infinity;
  try {
    fit({.complexity = 10});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("hessian_of[7]"), std::string::npos) << error.what();
  }
  scene.hessian_of.pop_back();
  EXPECT_THROW(fit({.complexity = 10}), InputError);
}

/// Two fronts that cross.
template <int Dim>
AnyField fronts(const AnyMesh& any) {
  AnyField field{
      Dim, any.vertex_count(), {AnyField::Type::scalar, AnyField::Type::scalar}, {}, "f"};
  for (std::size_t v = 0; v < any.vertex_count(); ++v)
    for (const std::size_t axis : {0, 1})
      field.values.push_back(std::tanh(10 * (any.coordinates[v * Dim + axis] - 0.5)));
  return field;
}

/// The first field as scalars.
AnyField scalars(const AnyField& field) { return scalar_field(field.dimension, scalars_of(field)); }

TYPED_TEST(HessianMetricIn, OfSeveralFieldsSuitsAll) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  const auto result =
      solution_metric(executor, scene.any, fronts<Dim>(scene.any), {.goal = {.complexity = 2000}});
  EXPECT_TRUE(result.fit.reached);
  const auto metric_of = tensors_of<Dim>(executor, result.metric);
  EXPECT_NEAR(complexity<Dim>(executor, scene.mesh, metric_of), 2000, 1e-3);
  const auto error =
      solution_metric(executor, scene.any, fronts<Dim>(scene.any), {.goal = {.error = 0.01}});
  EXPECT_TRUE(error.fit.reached);
  EXPECT_LE(error.fit.error, 0.01 * (1 + 1e-6));  // smaller where the other field rules
  EXPECT_GT(error.fit.error, 0.005);
  AnyField other = fronts<Dim>(scene.any);
  other.values.pop_back();
  EXPECT_THROW(solution_metric(executor, scene.any, other, {.goal = {.error = 0.01}}), InputError);
}

TYPED_TEST(HessianMetricIn, EstimatesTheErrorOfAFieldAsTheFitDoes) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  for (const double norm : {1.0, 2.0, std::numeric_limits<double>::infinity()}) {
    const auto result = solution_metric(executor, scene.any, scalars(fronts<Dim>(scene.any)),
                                        {.goal = {.norm = norm, .error = 0.01}});
    EXPECT_NEAR(result.fit.error, 0.01, 1e-6) << norm;
  }
}

/// The second field varies in a thin layer only. Sharing the complexity makes the first coarser,
/// but no size may exceed the extent of the mesh.
TYPED_TEST(HessianMetricIn, OfSeveralFieldsAsksForNoSizeLargerThanTheMesh) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  AnyField field = fronts<Dim>(scene.any);
  for (std::size_t v = 0; v < scene.mesh.vertex_count(); ++v)
    field.values[2 * v + 1] = std::exp(-300 * scene.mesh.position_of[v][1]);
  const auto result = solution_metric(executor, scene.any, field, {.goal = {.complexity = 50}});
  EXPECT_TRUE(result.fit.reached);
  for (const Metric<Dim>& metric : tensors_of<Dim>(executor, result.metric)) {
    const auto value = principal_axes(metric).value;
    EXPECT_GE(*std::min_element(value.begin(), value.end()), (1 - 1e-9) / Dim);  // extent sqrt(d)
  }
}

/// The function is linear in any direction, with an offset and the rounding of its sum.
TYPED_TEST(HessianMetricIn, OfALinearFieldIsUniform) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  for (int round = 0; round < 24; ++round) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 5 + 2 * round : 2 + round / 3));
    test::jiggle(any, random, 0.3);
    std::vector<double> value_of;
    Vector<Dim> slope;
    for (int axis = 0; axis < Dim; ++axis) slope[axis] = uniform(random, -2, 2);
    const double thickness = std::pow(10.0, -(round % 4));  // the mesh is stretched, too
    for (std::size_t v = 0; v < any.vertex_count(); ++v) {
      double& x = any.coordinates[v * Dim];
      if (round % 3 == 2) x *= x;  // and graded
      x *= thickness;
      value_of.push_back((round % 2 == 0 ? 0 : 100) + dot(slope, position_in<Dim>(any, v)));
    }
    for (const Recovery recovery : {Recovery::least_squares, Recovery::double_projection}) {
      const auto result = solution_metric(executor, any, scalar_field(Dim, value_of),
                                          {.goal = {.complexity = 1000}, .recovery = recovery});
      EXPECT_TRUE(result.fit.reached);
      const auto metric_of = tensors_of<Dim>(executor, result.metric);
      const auto mesh = make_fixed_mesh<Dim>(executor, any);
      const double volume = integral<Dim>(executor, mesh, std::vector(any.vertex_count(), 1.0));
      const double size = std::pow(1000 / volume, -1.0 / Dim);
      for (const Metric<Dim>& metric : metric_of)
        ASSERT_LT(difference(metric, isotropic<Dim>(size)), 1e-7) << round;
    }
  }
}

/// The curvature counts however small it is, if it exceeds rounding.
TYPED_TEST(HessianMetricIn, SeesTheCurvatureOfAFieldThatIsNearlyLinear) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  std::vector<double> value_of;
  for (const Vector<Dim>& x : scene.mesh.position_of)
    value_of.push_back(x[0] + 2 * x[1] + 1e-9 * std::tanh(10 * (x[0] - 0.5)));
  const auto result = solution_metric(executor, scene.any, scalar_field(Dim, value_of),
                                      {.goal = {.complexity = 1000}});
  double anisotropy = 1;
  for (const Metric<Dim>& metric : tensors_of<Dim>(executor, result.metric)) {
    const auto value = principal_axes(metric).value;
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    anisotropy = std::max(anisotropy, std::sqrt(*high / *low));
  }
  EXPECT_GT(anisotropy, 5);
}

/// The message names the first bad vertex of the field, not one that its Hessian spreads to.
TYPED_TEST(HessianMetricIn, NamesTheVertexWithAValueThatIsNoNumber) {
  constexpr int Dim = TypeParam::value;
  const Scene<Dim> scene;
  AnyField field = fronts<Dim>(scene.any);
  field.values[2 * 5 + 1] = field.values[2 * 8] = std::nan("");
  try {
    solution_metric(executor, scene.any, field, {.goal = {.complexity = 1000}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("at values[11], vertex 5;"), std::string::npos)
        << error.what();
  }
}

/// On a mesh that is still coarse, grading afterwards would make 10 times as many elements.
TYPED_TEST(HessianMetricIn, ReachesAComplexityWithGradation) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 20 : 8));
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  AnyField layer{Dim, any.vertex_count(), {AnyField::Type::scalar}, {}, "layer"};
  for (std::size_t v = 0; v < any.vertex_count(); ++v)
    layer.values.push_back(std::exp(-100 * position_in<Dim>(any, v)[0]));
  const SolutionMetricOptions options{
      .goal = {.complexity = 1500, .bounds = {.smallest = 1e-4, .anisotropy = 1e6}},
      .gradation = 1.5};
  const auto graded = solution_metric(executor, any, layer, options);
  auto metric_of = tensors_of<Dim>(executor, graded.metric);
  EXPECT_TRUE(graded.fit.reached);
  EXPECT_NEAR(complexity<Dim>(executor, mesh, metric_of), 1500, 30);
  EXPECT_EQ(limit_gradation(executor, metric_of, mesh, {.factor = 1.5, .tolerance = 2e-3}).raised,
            0U);
  auto after_of = tensors_of<Dim>(
      executor, solution_metric(executor, any, layer, {.goal = options.goal}).metric);
  limit_gradation(executor, after_of, mesh, {.factor = 1.5});
  EXPECT_GT(complexity<Dim>(executor, mesh, after_of), 5 * 1500);
  for (const double wrong : {0.5, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto before = metric_of;
    EXPECT_THROW(solution_metric(executor, any, layer, {.goal = options.goal, .gradation = wrong}),
                 InputError);
    EXPECT_THROW(scale_to_complexity<Dim>(executor, metric_of, mesh,
                                          {.complexity = 100, .gradation = wrong}),
                 InputError);
    EXPECT_EQ(metric_of, before);
  }
}

/// For any field and growth, the complexity is reached, no size is below its bound, and grading
/// again changes nothing, at any number of threads.
TYPED_TEST(HessianMetricIn, ReachesAComplexityWithAnyGradationOfAnyField) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 20 : 7));
  const auto mesh = make_fixed_mesh<Dim>(executor, any);
  for (int trial = 0; trial < 24; ++trial) {
    AnyField field{Dim, any.vertex_count(), {AnyField::Type::scalar}, {}, "field"};
    const double place = 0.1 + 0.03 * trial, sharp = 3 << (trial % 6);
    for (std::size_t v = 0; v < any.vertex_count(); ++v) {
      const auto p = position_in<Dim>(any, v);
      field.values.push_back(trial % 2 == 0 ? std::tanh(sharp * (p[0] + 0.3 * p[1] - place))
                                            : std::exp(-sharp * dot(p, p)) * std::cos(3 * p[1]));
    }
    const double factor = 1.1 + 0.1 * (trial % 5), goal = 300 << (trial % 4);
    const SolutionMetricOptions options{.goal = {.complexity = goal, .bounds = {.smallest = 1e-3}},
                                        .gradation = factor};
    const auto graded = solution_metric(executor, any, field, options);
    auto metric_of = tensors_of<Dim>(executor, graded.metric);
    EXPECT_TRUE(graded.fit.reached) << trial;
    EXPECT_NEAR(complexity<Dim>(executor, mesh, metric_of), goal, 0.02 * goal) << trial;
    for (const Metric<Dim>& metric : metric_of)
      for (const double value : principal_axes(metric).value) EXPECT_LT(value, 1.000001e6);
    const auto report =
        limit_gradation(executor, metric_of, mesh, {.factor = factor, .tolerance = 2e-3});
    EXPECT_EQ(report.raised, 0U) << trial;
    const auto again = solution_metric(Executor({.threads = 3}), any, field, options);
    EXPECT_EQ(again.metric.values, graded.metric.values) << trial;
  }
}

TYPED_TEST(HessianMetricIn, DoesNotDependOnThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 50 : 14));
  const auto run = [&](int threads) {
    return solution_metric(Executor({.threads = threads}), any, fronts<Dim>(any),
                           {.goal = {.complexity = 3000, .bounds = {.smallest = 0.01}},
                            .recovery = Recovery::double_projection})
        .metric.values;
  };
  const auto expected = run(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(expected, run(threads)) << threads;
}

}  // namespace
}  // namespace ductile::meshadapt::hessian_metric_test
