// Functions of level sets: their values, the closest points of their zero, and adapt() with the
// surface where they are 0, whatever they are like.

#include "ductile/meshadapt/level_set_function.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/ball_in_box.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::level_set_function_test {
namespace {

using runtime::Executor;
using Point = std::array<double, 3>;
using Function = std::function<double(const Point&)>;

template <class Dimension>
class LevelSetFunctionIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(LevelSetFunctionIn, Dimensions, );

Point point_of(const std::vector<double>& coordinates, std::size_t dimension, std::size_t i) {
  Point point{};
  for (std::size_t k = 0; k < dimension; ++k) point[k] = coordinates[dimension * i + k];
  return point;
}

std::vector<double> values_on(const AnyMesh& mesh, const Function& function) {
  std::vector<double> values;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    values.push_back(
        function(point_of(mesh.coordinates, static_cast<std::size_t>(mesh.dimension), v)));
  return values;
}

/// A grid over the cube from -1 to 1, moved inside.
AnyMesh background(int dimension, int n, test::Random& random) {
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension, n));
  test::jiggle(mesh, random, 0.2);
  for (double& x : mesh.coordinates) x = 2 * x - 1;
  return mesh;
}

/// An ellipsoid, a hyperboloid or the like, with known gradients.
struct Quadric {
  std::array<double, 3> square, slope;
  double constant;

  static Quadric random(test::Random& random) {
    Quadric quadric{};
    for (std::size_t k = 0; k < 3; ++k) {
      quadric.square[k] = test::uniform(random, -1, 2);
      quadric.slope[k] = test::uniform(random, -1, 1);
    }
    quadric.constant = test::uniform(random, -0.6, 0.2);
    return quadric;
  }
  double operator()(const Point& p) const {
    double sum = constant;
    for (std::size_t k = 0; k < 3; ++k) sum += (square[k] * p[k] + slope[k]) * p[k];
    return sum;
  }
};

TYPED_TEST(LevelSetFunctionIn, IsExactForQuadraticsAndFindsTheirZero) {
  const Executor executor({.threads = 2});
  constexpr auto d = static_cast<std::size_t>(TypeParam::value);
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < test::trials(8); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const AnyMesh mesh = background(TypeParam::value, d == 2 ? 9 : 6, random);
    const Quadric quadric = Quadric::random(random);
    const double level = test::uniform(random, -0.2, 0.2);
    const LevelSetFunction function(executor, mesh, values_on(mesh, quadric), level);
    std::vector<double> points(200 * d);
    for (double& x : points) x = test::uniform(random, -0.98, 0.98);
    const std::vector<double> values = function.at(executor, points);
    const SurfaceFunction surface = function.surface(7, 0.3);
    EXPECT_EQ(surface.reference, 7);
    EXPECT_TRUE(surface.approximate);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Point p = point_of(points, d, i);
      EXPECT_NEAR(values[i], quadric(p) - level, 1e-9);
      const Point q = surface.closest(p);
      if (!std::isfinite(q[0])) continue;
      ++found;
      EXPECT_LE(std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]), 0.3);
      EXPECT_NEAR(quadric(q), level, 1e-9);
      const Point again = surface.closest(q);
      for (std::size_t k = 0; k < d; ++k) EXPECT_NEAR(again[k], q[k], 1e-11);
    }
  }
  EXPECT_GT(found, 100U);
}

TYPED_TEST(LevelSetFunctionIn, DoesNotKnowASurfaceThatIsFarOrNotThere) {
  const Executor executor({.threads = 2});
  test::Random random(5);
  const AnyMesh mesh = background(TypeParam::value, 6, random);
  const auto closest = [&](const Function& f, double within) {
    return LevelSetFunction(executor, mesh, values_on(mesh, f))
        .surface(1, within)
        .closest({0.3, 0.2, 0});
  };
  EXPECT_TRUE(std::isnan(closest([](const Point& p) { return p[0] - 0.5; }, 0.19)[0]));
  EXPECT_NEAR(closest([](const Point& p) { return p[0] - 0.5; }, 0.21)[0], 0.5, 1e-12);
  EXPECT_TRUE(std::isnan(closest([](const Point&) { return 1.0; }, 10)[0]));
  EXPECT_TRUE(std::isnan(closest([](const Point& p) { return p[0] * p[0] + 0.5; }, 10)[0]));
}

TYPED_TEST(LevelSetFunctionIn, RefusesValuesThatAreMissing) {
  const Executor executor({.threads = 1});
  test::Random random(6);
  const AnyMesh mesh = background(TypeParam::value, 3, random);
  std::vector<double> values(mesh.vertex_count(), 1);
  const auto message = [&] {
    try {
      LevelSetFunction(executor, mesh, values);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  values[3] = std::nan("");
  EXPECT_EQ(message(), "level set: expected finite numbers, found nan at values[3]");
  values.pop_back();
  EXPECT_NE(message().find("expected a value for each of the"), std::string::npos);
}

// ---- Adaptation ----

constexpr double radius = 0.5, tolerance = 0.02;  // facets are off by 0.015 in 3D

double distance_from_ball(const Point& p) { return std::hypot(p[0], p[1], p[2]) - radius; }

AdaptedMesh adapted(const Executor& executor, const AnyMesh& mesh, const SurfaceFunction& surface,
                    double size) {
  AdaptOptions options;
  options.gradation = 1.3;
  options.make.hausdorff_tolerance = tolerance;
  options.make.functions = {surface};
  return adapt(executor, mesh, constant_metric(mesh, size), options);
}

TYPED_TEST(LevelSetFunctionIn, HasTheVerticesOfAdaptedInterfacesOnIt) {
  const Executor executor({.threads = 2});
  constexpr auto d = static_cast<std::size_t>(TypeParam::value);
  test::Random random(7);
  const AnyMesh mesh = test::ball_in_box(TypeParam::value, d == 2 ? 16 : 8, radius);
  const AnyMesh grid = background(TypeParam::value, d == 2 ? 20 : 12, random);
  const SurfaceFunction surface =
      LevelSetFunction(executor, grid, values_on(grid, distance_from_ball))
          .surface(test::ball_interface, tolerance);
  const AdaptedMesh result = adapted(executor, mesh, surface, d == 2 ? 0.06 : 0.15);
  EXPECT_EQ(test::joined(check_adapted(executor, mesh, result.mesh, tolerance)), "");
  std::size_t on_it = 0, all = 0;
  for (const std::uint32_t v : test::interface_vertices(result.mesh)) {
    const Point p = point_of(result.mesh.coordinates, d, v), q = surface.closest(p);
    EXPECT_LT(std::abs(distance_from_ball(p)), 0.25 * tolerance);
    on_it += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) < 1e-6 * tolerance ? 1 : 0;
    ++all;
  }
  EXPECT_GE(on_it, all - all / 20) << "few are held by what is around them";
}

/// Sizes of chords: those of a ball by its radius, of planes and at edges of boxes none.
TYPED_TEST(LevelSetFunctionIn, HasSizesFromItsCurvature) {
  const Executor executor({.threads = 2});
  constexpr int d = TypeParam::value;
  constexpr double share = d == 2 ? 0.25 : 0.4;
  for (std::uint64_t seed = 0; seed < test::trials(4); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const AnyMesh mesh = background(d, d == 2 ? 30 : 16, random);
    const double r = test::uniform(random, 0.4, 0.7), x = test::uniform(random, -0.3, 0.3);
    const auto largest_at = [&](const Function& f, const Point& at) {
      const auto sizes =
          LevelSetFunction(executor, mesh, values_on(mesh, f)).surface(1, tolerance).sizes(at);
      Metric<d> tensor;
      std::copy_n(sizes.begin(), tensor.m.size(), tensor.m.begin());
      const auto axes = principal_axes(tensor);
      return *std::max_element(axes.value.begin(), axes.value.end());
    };
    const auto ball = [r](const Point& p) { return std::hypot(p[0], p[1], p[2]) - r; };
    const double a = test::uniform(random, 0, 6), expected = 1 / (8 * share * tolerance * r);
    EXPECT_NEAR(largest_at(ball, {r * std::cos(a), r * std::sin(a), 0}) / expected, 1, 0.2);
    const auto plane = [x](const Point& p) { return p[0] + x * p[1] - x; };
    EXPECT_LT(largest_at(plane, {x, 0, 0}), 1e-6 * expected);
    const auto box = [x](const Point& p) { return std::max(p[0], p[1]) - x; };
    EXPECT_LT(largest_at(box, {x, x, 0}), 1e-6 * expected);
  }
}

TYPED_TEST(LevelSetFunctionIn, MakesInterfacesFinerWhereTheyBendAlone) {
  const Executor executor({.threads = 2});
  constexpr auto d = static_cast<std::size_t>(TypeParam::value);
  test::Random random(9);
  const AnyMesh mesh = test::ball_in_box(TypeParam::value, d == 2 ? 16 : 8, radius);
  const AnyMesh grid = background(TypeParam::value, d == 2 ? 20 : 12, random);
  SurfaceFunction surface = LevelSetFunction(executor, grid, values_on(grid, distance_from_ball))
                                .surface(test::ball_interface, tolerance);
  const auto count = [&] {
    const AnyMesh result = adapted(executor, mesh, surface, d == 2 ? 0.2 : 0.22).mesh;
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, result, tolerance)), "");
    return test::interface_vertices(result).size();
  };
  const std::size_t finer = count();
  surface.sizes = nullptr;
  const std::size_t coarser = count();
  EXPECT_GT(finer, 1.1 * static_cast<double>(coarser));
  EXPECT_LT(finer, 3 * coarser);
  surface.sizes = [](const Point&) { return std::array<double, 6>{}; };
  EXPECT_EQ(count(), coarser);
}

TYPED_TEST(LevelSetFunctionIn, GivesTheSameBytesAtAnyNumberOfThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  test::Random random(8);
  const AnyMesh mesh = test::ball_in_box(TypeParam::value, TypeParam::value == 2 ? 16 : 6, radius);
  const AnyMesh grid = background(TypeParam::value, 10, random);
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 3, 4, 8}) {
    const Executor executor({.threads = threads});
    const LevelSetFunction function(executor, grid, values_on(grid, distance_from_ball));
    auto found =
        test::bits(adapted(executor, mesh, function.surface(test::ball_interface, tolerance), 0.15)
                       .mesh.coordinates);
    const auto values = test::bits(function.at(executor, mesh.coordinates));
    found.insert(found.end(), values.begin(), values.end());
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected) << threads << " threads";
  }
}

/// Where the function has nothing to say of the interface, the mesh's own model counts.
TYPED_TEST(LevelSetFunctionIn, NeverMakesAnAdaptationFail) {
  const Executor executor({.threads = 2});
  constexpr auto d = static_cast<std::size_t>(TypeParam::value);
  const AnyMesh mesh = test::ball_in_box(TypeParam::value, d == 2 ? 12 : 6, radius);
  for (std::uint64_t seed = 0; seed < test::trials(12); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const AnyMesh grid = background(TypeParam::value, 8, random);
    const Quadric quadric = Quadric::random(random);
    const double noise = test::chance(random, 0.5) ? test::uniform(random, 0, 0.2) : 0;
    const int kind = static_cast<int>(seed % 4);
    const auto values = values_on(grid, [&](const Point& p) {
      const double ball = distance_from_ball(p), off = noise * test::uniform(random, -1, 1);
      return (kind == 0   ? quadric(p)
              : kind == 1 ? std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) - radius
              : kind == 2 ? std::abs(ball) - 0.02
                          : ball) +
             off;
    });
    const SurfaceFunction surface =
        LevelSetFunction(executor, grid, values).surface(test::ball_interface, 10 * tolerance);
    const AdaptedMesh result = adapted(executor, mesh, surface, d == 2 ? 0.08 : 0.25);
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, result.mesh, tolerance)), "");
  }
}

}  // namespace
}  // namespace ductile::meshadapt::level_set_function_test
