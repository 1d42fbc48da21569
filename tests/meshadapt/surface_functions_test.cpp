// Surfaces given by functions: vertices of adapted meshes lie on them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::surface_functions_test {
namespace {

using runtime::Executor;
using Point = std::array<double, 3>;

constexpr double radius = 0.5, ring = 1.1, tube = 0.4, tolerance = 0.004;

// ---- Closest points ----

Point on_ball(const Point& p) {
  const double scale = radius / std::hypot(p[0], p[1], p[2]);
  return {scale * p[0], scale * p[1], scale * p[2]};
}
Point on_cylinder(const Point& p) {
  const double scale = radius / std::hypot(p[0], p[1]);
  return {scale * p[0], scale * p[1], p[2]};
}
/// The closest point of a torus around the z axis.
Point on_torus(const Point& p) {
  const double far = std::hypot(p[0], p[1]);
  const double scale = tube / std::hypot(far - ring, p[2]);
  const double out = (ring + scale * (far - ring)) / far;
  return {out * p[0], out * p[1], scale * p[2]};
}

// ---- Shapes: the round part has reference 1 ----

struct Shape {
  const char* name;
  int dimension;
  Point (*closest)(const Point&);
};

/// Maps a point of the unit square to the disk of radius 1.
std::array<double, 2> in_disk(double x, double y) {
  const double far = std::hypot(x = 2 * x - 1, y = 2 * y - 1);
  const double scale = far > 0 ? std::max(std::abs(x), std::abs(y)) / far : 0;
  return {scale * x, scale * y};
}

void place(const Shape& shape, double* x) {
  if (shape.closest == on_ball && shape.dimension == 3) {
    double most = 0, square = 0;
    for (int i = 0; i < 3; ++i) {
      x[i] = 2 * x[i] - 1;
      most = std::max(most, std::abs(x[i]));
      square += x[i] * x[i];
    }
    for (int i = 0; i < 3 && square > 0; ++i) x[i] *= radius * most / std::sqrt(square);
    return;
  }
  const auto [u, v] = in_disk(x[0], x[1]);
  x[0] = radius * u;
  x[1] = radius * v;
  if (shape.closest != on_torus) return;
  const double far = ring + tube * u, turn = 0.5 * std::numbers::pi * x[2];
  x[0] = far * std::cos(turn);
  x[1] = -far * std::sin(turn);
  x[2] = tube * v;
}

AnyMesh mesh_of(const Shape& shape) {
  const int n = shape.dimension == 2 ? 40 : 12;
  AnyMesh mesh = test::make_grid(test::unit_grid(shape.dimension, n));
  const auto d = static_cast<std::size_t>(shape.dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) place(shape, &mesh.coordinates[d * v]);
  auto& references = shape.dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
  for (auto& reference : references)
    if (shape.closest == on_ball || reference < 5) reference = 1;
  return mesh;
}

Point position(const AnyMesh& mesh, std::size_t vertex) {
  Point point{};
  const auto d = static_cast<std::size_t>(mesh.dimension);
  std::copy_n(&mesh.coordinates[d * vertex], d, point.begin());
  return point;
}

/// Largest distance of vertices of facets with reference 1 from their surface.
double off(const Shape& shape, const AnyMesh& mesh) {
  std::set<std::uint32_t> on_it;
  const auto add = [&](const auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      if (facets.reference[f] == 1)
        on_it.insert(facets.vertices[f].begin(), facets.vertices[f].end());
  };
  mesh.dimension == 2 ? add(mesh.edges) : add(mesh.triangles);
  double most = 0;
  for (const std::uint32_t v : on_it) {
    const Point p = position(mesh, v), q = shape.closest(p);
    most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return most;
}

/// Sizes with a front that moves from call to call.
AnyField front(const AnyMesh& mesh, int call) {
  AnyField sizes{mesh.dimension, mesh.vertex_count(), {AnyField::Type::scalar}, {}, "sizes"};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double away = std::abs(position(mesh, v)[0] - 0.5 * std::cos(0.7 * call));
    sizes.values.push_back(std::min(0.2, 0.07 + 0.4 * away));
  }
  return metric_of(sizes, mesh, {});
}

AdaptOptions options_with(const Executor& executor, const AnyMesh& mesh,
                          const std::vector<SurfaceFunction>& functions) {
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  options.make.geometry = std::make_shared<const Geometry>(
      executor, mesh, GeometryOptions{.tolerance = tolerance, .functions = functions});
  return options;
}

class SurfaceFunctions : public testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, SurfaceFunctions,
                         testing::Values(Shape{"Disk", 2, on_ball}, Shape{"Ball", 3, on_ball},
                                         Shape{"Cylinder", 3, on_cylinder},
                                         Shape{"QuarterTorus", 3, on_torus}),
                         [](const auto& at) { return std::string(at.param.name); });

TEST_P(SurfaceFunctions, HaveAllVerticesOnThemInTenCalls) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const Executor executor({.threads = 2});
  AnyMesh mesh = mesh_of(GetParam());
  const AdaptOptions options = options_with(executor, mesh, {{1, GetParam().closest}});
  for (int call = 1; call <= 10; ++call) {
    const AdaptedMesh adapted = adapt(executor, mesh, front(mesh, call), options);
    EXPECT_EQ(test::joined(check_adapted(executor, mesh, adapted.mesh, tolerance)), "");
    mesh = adapted.mesh;
    EXPECT_LT(off(GetParam(), mesh), 1e-12) << "call " << call;
  }
}

TEST_P(SurfaceFunctions, NeedNoGeometry) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const Executor executor({.threads = 2});
  AnyMesh mesh = mesh_of(GetParam());
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  options.make.functions = {{1, GetParam().closest}};
  for (int call = 1; call <= 2; ++call)
    mesh = adapt(executor, mesh, front(mesh, call), options).mesh;
  EXPECT_LT(off(GetParam(), mesh), 1e-12);
  mesh = adapt_to_sizes(executor, mesh, {.elsewhere = 0.15}, options).mesh;
  EXPECT_LT(off(GetParam(), mesh), 1e-12);
}

TEST_P(SurfaceFunctions, GiveTheSameBytesAtAnyNumberOfThreads) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const AnyMesh first = mesh_of(GetParam());
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 3, 4, 8}) {
    const Executor executor({.threads = threads});
    const AdaptOptions options = options_with(executor, first, {{1, GetParam().closest}});
    AnyMesh mesh = first;
    for (int call = 1; call <= 2; ++call)
      mesh = adapt(executor, mesh, front(mesh, call), options).mesh;
    const auto found = test::bits(mesh.coordinates);
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected) << threads << " threads";
  }
}

TEST_P(SurfaceFunctions, AreWhatAGeometryHas) {
  const Shape& shape = GetParam();
  const AnyMesh mesh = mesh_of(shape);
  const Geometry geometry(Executor({.threads = 2}), mesh,
                          {.tolerance = tolerance, .functions = {{1, shape.closest}}});
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    Point point = position(mesh, v);
    for (double& x : point) x *= 1.02;
    const auto found = geometry.closest(point, 0.05);
    if (!found || found->reference != 1) continue;
    const Point again = shape.closest(found->position);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found->position[i], again[i], 1e-14);
  }
}

// ---- Refusals ----

const Shape ball{"Ball", 3, on_ball};

/// The error for these functions in a geometry of the ball.
std::string message_for(const std::vector<SurfaceFunction>& functions) {
  try {
    Geometry(Executor({.threads = 2}), mesh_of(ball),
             {.tolerance = tolerance, .functions = functions});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SurfaceFunctionErrors, NameTheReferenceAndThePoint) {
  const auto shrunk = [](const Point& p) {
    const Point q = on_ball(p);
    return Point{0.95 * q[0], 0.95 * q[1], 0.95 * q[2]};
  };
  EXPECT_NE(message_for({{1, shrunk}}).find("reference 1: expected vertex"), std::string::npos);
  const auto nowhere = [](const Point&) { return Point{std::nan(""), 0, 0}; };
  EXPECT_NE(message_for({{1, nowhere}}).find("reference 1: expected a point within"),
            std::string::npos);
  const auto far = [](const Point&) { return Point{1e300, 0, 0}; };
  EXPECT_NE(message_for({{1, far}}).find("reference 1: expected a point within"),
            std::string::npos);
  EXPECT_NE(message_for({{7, on_ball}}).find("no facet has the reference 7"), std::string::npos);
  EXPECT_NE(message_for({{1, on_ball}, {1, on_ball}}).find("twice"), std::string::npos);
  EXPECT_NE(message_for({{1, {}}}).find("reference 1 is empty"), std::string::npos);
}

TEST(SurfaceFunctionErrors, ComeOutOfTheMiddleOfAnAdaptation) {
  const AnyMesh mesh = mesh_of(ball);
  const auto adapt_with = [&](int threads, auto&& away) {
    const Executor executor({.threads = threads});
    const auto function = [&](const Point& p) {
      // Vertices of the input are on the ball; new ones are not yet.
      const bool is_new = std::abs(std::hypot(p[0], p[1], p[2]) - radius) > 1e-6;
      return is_new ? away(p) : on_ball(p);
    };
    adapt(executor, mesh, constant_metric(mesh, 0.04),
          options_with(executor, mesh, {{1, function}}));
  };
  for (const int threads : {1, 2, 4}) {
    EXPECT_THROW(adapt_with(threads,
                            [](const Point&) {
                              return Point{std::nan(""), 0, 0};
                            }),
                 InputError);
    EXPECT_THROW(adapt_with(threads, [](const Point&) -> Point { throw std::domain_error("no"); }),
                 std::domain_error);
  }
}

TEST(SurfaceFunctionErrors, AreForFunctionsThatMeanNothing) {
  const Executor executor({.threads = 1});
  const AnyMesh mesh = mesh_of(ball);
  AdaptOptions options;
  options.make.functions = {{1, on_ball}};
  const AnyField metric = constant_metric(mesh, 0.2);
  EXPECT_THROW(adapt(executor, mesh, metric, options), InputError) << "no tolerance";
  options = options_with(executor, mesh, {});
  options.make.functions = {{1, on_ball}};
  EXPECT_THROW(adapt(executor, mesh, metric, options), InputError) << "functions and a geometry";
}

}  // namespace
}  // namespace ductile::meshadapt::surface_functions_test
