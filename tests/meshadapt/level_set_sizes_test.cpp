#include "ductile/meshadapt/level_set_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/level_set_function.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::level_set_sizes_test {
namespace {

using runtime::Executor;

template <class Dimension>
class LevelSetSizesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LevelSetSizesIn, Dimensions, );

/// A function of one point, for many.
template <int Dim>
PointFunction at_each(auto function) {
  return [function](std::span<const double> coordinates) {
    std::vector<double> values(coordinates.size() / Dim);
    for (std::size_t i = 0; i < values.size(); ++i) {
      Vector<Dim> point;
      std::copy_n(&coordinates[i * Dim], Dim, point.x.begin());
      values[i] = function(point);
    }
    return values;
  };
}

template <int Dim>
Vector<Dim> random_point(test::Random& random) {
  Vector<Dim> point;
  for (int k = 0; k < Dim; ++k) point[k] = test::uniform(random, 0.35, 0.65);
  return point;
}

template <int Dim>
AnyMesh coarse(test::Random& random) {
  AnyMesh mesh = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 12 : 6));
  test::jiggle(mesh, random, 0.2);
  mesh.name = "grid";
  return mesh;
}

constexpr double size_in(int dimension) { return dimension == 2 ? 1.0 / 12 : 1.0 / 6; }

/// How much volume has negative values of the linear interpolant, by points inside the elements.
template <int Dim>
double negative_volume(const AnyMesh& mesh, const std::vector<double>& value_of) {
  double sum = 0;
  constexpr int n = 6;
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    std::array<Vector<Dim>, Dim> along;
    for (std::size_t i = 0; i < Dim; ++i)
      along[i] = test::point<Dim>(mesh, corners[i + 1]) - test::point<Dim>(mesh, corners[0]);
    double volume = 0;
    if constexpr (Dim == 2)
      volume = std::abs(along[0][0] * along[1][1] - along[0][1] * along[1][0]) / 2;
    else
      volume = std::abs(dot(along[0], cross(along[1], along[2]))) / 6;
    int inside = 0, all = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        for (int k = 0; k < (Dim == 2 ? 1 : n - i - j); ++k, ++all) {
          const std::array<double, 4> w{(i + 0.25) / n, (j + 0.25) / n,
                                        Dim == 2 ? 0 : (k + 0.25) / n, 0};
          const double rest = 1 - w[0] - w[1] - w[2];
          double value = rest * value_of[corners[0]];
          for (std::size_t c = 0; c < Dim; ++c) value += w[c] * value_of[corners[c + 1]];
          inside += value < 0 ? 1 : 0;
        }
    sum += volume * inside / all;
  }
  return sum;
}

TYPED_TEST(LevelSetSizesIn, ResolveFilmsAndSpecksThatTheMeshDoesNotShow) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = 0; seed < test::trials(dim == 2 ? 12 : 3); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const AnyMesh mesh = coarse<dim>(random);
    const auto centre = random_point<dim>(random);
    const bool is_film = seed % 2 == 0;
    const double half = (dim == 2 ? 0.1 : 0.3) * size_in(dim);
    const double radius = is_film ? (dim == 2 ? 0.25 : 0.2) : (dim == 2 ? 0.4 : 0.6) * size_in(dim);
    const auto function = at_each<dim>([=](const Vector<dim>& p) {
      const double ball = norm(p - centre) - radius;
      return is_film ? std::abs(ball) - half : ball;
    });
    const AdaptedMesh result = refine_to_level_set(
        executor, mesh, constant_metric(mesh, size_in(dim)), function,
        {.tolerance = 0.2 * half, .most_passes = 20, .adapt = {.gradation = 1.3}});
    EXPECT_EQ(test::joined(result.report.warnings), "");
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, result.mesh)), "");
    const auto ball = [](double r) {
      return dim == 2 ? std::numbers::pi * r * r : 4 * std::numbers::pi * r * r * r / 3;
    };
    const double volume = is_film ? ball(radius + half) - ball(radius - half) : ball(radius);
    EXPECT_NEAR(negative_volume<dim>(result.mesh, function(result.mesh.coordinates)) / volume, 1,
                0.15);
  }
}

/// Functions that no mesh resolves at some places: bodies that touch, crossing planes, edges, cones
/// and double zeros; and smooth ones, of which chords between vertices near the zero always have
/// other signs in the middle.
template <int Dim>
double hard_function(int kind, const Vector<Dim>& p, const Vector<Dim>& centre, double scale) {
  const Vector<Dim> d = p - centre;
  double most = 0, waves = 0;
  for (int k = 0; k < Dim; ++k) {
    most = std::max(most, std::abs(d[k]));
    waves += std::sin(scale * p[k]) * std::cos(scale * p[(k + 1) % Dim]);
  }
  Vector<Dim> left = d, right = d;
  left[0] += 0.2;
  right[0] -= 0.2;
  return kind == 0   ? waves
         : kind == 1 ? std::min(norm(left), norm(right)) - 0.2
         : kind == 2 ? d[0] * d[1]
         : kind == 3 ? most - 0.25
         : kind == 4 ? norm(left) * norm(right) - 0.04
                     : dot(d, d) - 4 * d[0] * d[0];
}

TYPED_TEST(LevelSetSizesIn, EndWhereAFunctionIsKinkedOrSingular) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = 0; seed < test::trials(dim == 2 ? 24 : 6); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const AnyMesh mesh = coarse<dim>(random);
    const auto centre = random_point<dim>(random);
    const double scale = test::uniform(random, 4, 9);
    const double tolerance = (dim == 2 ? 0.03 : 0.15) * size_in(dim);
    const auto function = at_each<dim>([=](const Vector<dim>& p) {
      return hard_function<dim>(static_cast<int>(seed % 6), p, centre, scale);
    });
    const AdaptedMesh result =
        refine_to_level_set(executor, mesh, constant_metric(mesh, size_in(dim)), function,
                            {.tolerance = tolerance, .adapt = {.gradation = 1.3}});
    EXPECT_EQ(test::joined(result.report.warnings), "");
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, result.mesh)), "");
    EXPECT_GT(elements_in<dim>(result.mesh).size(), elements_in<dim>(mesh).size());
  }
}

TYPED_TEST(LevelSetSizesIn, AskForNothingMoreWhereTheZeroIsResolved) {
  constexpr int dim = TypeParam::value;
  const Executor executor({.threads = 2});
  test::Random random(3);
  const AnyMesh mesh = coarse<dim>(random);
  const AnyField metric = constant_metric(mesh, size_in(dim));
  const auto slope = random_point<dim>(random);
  for (const double factor : {1e-6, 1.0, 1e6}) {
    const auto plane =
        at_each<dim>([=](const Vector<dim>& p) { return factor * (dot(slope, p) - 0.5); });
    const auto far = at_each<dim>([=](const Vector<dim>& p) { return factor * (norm(p) + 0.3); });
    for (const PointFunction& function : {PointFunction(plane), PointFunction(far)}) {
      const AdaptedMesh found =
          refine_to_level_set(executor, mesh, metric, function, {.tolerance = 0.01});
      EXPECT_EQ(found.mesh, mesh);
      EXPECT_EQ(found.metric.values, metric.values);
    }
  }
}

TYPED_TEST(LevelSetSizesIn, FollowAFunctionKnownAtVerticesAtAnyNumberOfThreads) {
  constexpr int dim = TypeParam::value;
  test::Random random(4);
  const AnyMesh mesh = coarse<dim>(random);
  const auto centre = random_point<dim>(random);
  const auto film = at_each<dim>(
      [=](const Vector<dim>& p) { return std::abs(norm(p - centre) - 0.2) - 0.3 * size_in(dim); });
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 3, 4, 8}) {
    const Executor executor({.threads = threads});
    const LevelSetFunction known(executor, mesh, film(mesh.coordinates));
    const AdaptedMesh result = refine_to_level_set(
        executor, mesh, constant_metric(mesh, size_in(dim)),
        [&](std::span<const double> points) { return known.at(executor, points); },
        {.tolerance = 0.02, .most_passes = 3, .adapt = {.gradation = 1.3}});
    EXPECT_GT(elements_in<dim>(result.mesh).size(), elements_in<dim>(mesh).size());
    if (expected.empty()) expected = test::bits(result.mesh.coordinates);
    EXPECT_EQ(test::bits(result.mesh.coordinates), expected) << threads << " threads";
  }
}

TEST(LevelSetSizesErrors, SayWhatWasExpected) {
  const Executor executor({.threads = 1});
  test::Random random(5);
  const AnyMesh mesh = coarse<2>(random);
  const auto message = [&](const PointFunction& function, const LevelSetSizesOptions& sizes) {
    try {
      refine_to_level_set(executor, mesh, constant_metric(mesh, 0.1), function, sizes);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto none = [](std::span<const double>) { return std::vector<double>(); };
  const auto wrong =
      at_each<2>([](const Vector<2>& p) { return p[0] > 0.5 ? std::nan("") : p[0] - 0.2; });
  EXPECT_NE(message(none, {.tolerance = 0.1}).find("values, one for each point, found 0"),
            std::string::npos);
  EXPECT_NE(message(wrong, {.tolerance = 0.1}).find("expected a finite value at ("),
            std::string::npos);
  EXPECT_EQ(message({}, {.tolerance = 0.1}), "level set: expected a function, found none");
  EXPECT_NE(message(wrong, {}).find("expected a tolerance from"), std::string::npos);
}

}  // namespace
}  // namespace ductile::meshadapt::level_set_sizes_test
