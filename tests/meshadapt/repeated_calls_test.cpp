/// @file
/// Adapts meshes with curved boundaries again and again, each time the previous result, with sizes
/// that grow from those that their boundaries ask for: it must not get finer with each call.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::repeated_calls_test {
namespace {

using runtime::Executor;
using test::Random;

const Executor executor({.threads = 2});

/// Widens the unit square or cube to [-1, 1] across its axis, and turns the squares around the axis
/// into circles, up to the fraction `radius`; outside, they change gradually back to squares.
void round_off(AnyMesh& mesh, double radius) {
  const auto size = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += size) {
    double &x = mesh.coordinates[at], &y = mesh.coordinates[at + 1];
    x = 2 * x - 1;
    y = 2 * y - 1;
    const double from_axis = std::hypot(x, y), square = std::max(std::abs(x), std::abs(y));
    if (!(from_axis > 0)) continue;
    const double round = square / from_axis;
    const double share = radius < 1 ? std::clamp((square - radius) / (1 - radius), 0.0, 1.0) : 0;
    x *= share + (1 - share) * round;
    y *= share + (1 - share) * round;
  }
}

/// Two regions, inside and around a circle or cylinder; if hollow, only the outer one.
AnyMesh cylinder_in_box(int dimension, int n, bool hollow) {
  test::Grid grid = test::unit_grid(dimension, n);
  grid.region = [=](const test::Cell& cell) {
    const auto inside = [&](int c) { return c >= n / 4 && c < n - n / 4; };
    return inside(cell[0]) && inside(cell[1]) ? (hollow ? 0 : 2) : 1;
  };
  AnyMesh mesh = test::make_grid(grid);
  const int quarter = n / 4;
  round_off(mesh, 1 - 2.0 * quarter / n);
  return mesh;
}

AnyMesh disc(int n) {
  AnyMesh mesh = test::make_grid(test::unit_grid(2, n));
  round_off(mesh, 1);
  std::fill(mesh.edges.reference.begin(), mesh.edges.reference.end(), 1);
  return mesh;
}

AnyMesh ball(int n) {
  AnyMesh mesh = test::make_grid(test::unit_grid(3, n));
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3) {
    double* p = &mesh.coordinates[at];
    for (int i = 0; i < 3; ++i) p[i] = 2 * p[i] - 1;
    const double radius = std::hypot(p[0], p[1], p[2]);
    const double cube = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    for (int i = 0; i < 3 && radius > 0; ++i) p[i] *= cube / radius;
  }
  std::fill(mesh.triangles.reference.begin(), mesh.triangles.reference.end(), 1);
  return mesh;
}

/// A part of a torus with radius 3, whose tube has radius 1.
AnyMesh bent_tube(int n, double angle) {
  AnyMesh mesh = test::make_grid(test::unit_grid(3, n));
  round_off(mesh, 1);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3) {
    double* p = &mesh.coordinates[at];
    const double radius = 3 + p[0], turn = angle * p[2];
    p[0] = radius * std::cos(turn);
    p[2] = radius * std::sin(turn);
  }
  for (std::int32_t& reference : mesh.triangles.reference) reference = std::max(reference, 4);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3)  // the map mirrors
    mesh.coordinates[at + 1] *= -1;
  return mesh;
}

/// A mesh of one or two cells per axis, with all vertices moved.
AnyMesh random_mesh(int dimension, Random& random) {
  for (;;) {
    test::Grid grid = test::unit_grid(dimension, 1 + static_cast<int>(test::below(random, 2)));
    grid.region =
        test::random_regions(random(), 1 + static_cast<int>(test::below(random, 2)), true);
    AnyMesh mesh = test::make_grid(grid);
    if (mesh.coordinates.empty()) continue;
    const AnyMesh before = mesh;
    for (double& x : mesh.coordinates) x += test::uniform(random, -0.12, 0.12);
    if (check_mesh(executor, mesh).empty()) return mesh;
  }
}

std::size_t element_count(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

struct Request {
  double size;  ///< 0: that of the mesh
  double tolerance;
  double gradation = 1.3;
};

void settles(AnyMesh mesh, const Request& request) {
  AdaptOptions options;
  options.gradation = request.gradation;
  options.make.hausdorff_tolerance = request.tolerance;
  std::size_t first = 0;
  std::string counts;
  for (int call = 0; call < 10; ++call) {
    const AnyField metric =
        request.size > 0 ? constant_metric(mesh, request.size) : implied_metric(mesh);
    AdaptedMesh result = adapt(executor, mesh, metric, options);
    mesh = std::move(result.mesh);
    if (call == 0) first = element_count(mesh);
    counts += " " + std::to_string(element_count(mesh));
    ASSERT_LT(element_count(mesh), 1.2 * static_cast<double>(first) + 20) << counts;
  }
}

TEST(RepeatedCalls, OnDiscsAndRings) {
  for (const double tolerance : {0.03, 0.005, 0.001})
    for (const double size : {0.0, 0.1, 0.4}) {
      SCOPED_TRACE("tolerance " + std::to_string(tolerance) + ", size " + std::to_string(size));
      settles(disc(10), {size, tolerance});
      settles(cylinder_in_box(2, 16, true), {size, tolerance});
      settles(cylinder_in_box(2, 16, false), {size, tolerance});
    }
}

TEST(RepeatedCalls, OnACylinderInABox) {
  for (const double tolerance : {0.05, 0.01, 0.002})
    for (const double size : {0.0, 0.2, 0.5}) {
      SCOPED_TRACE("tolerance " + std::to_string(tolerance) + ", size " + std::to_string(size));
      settles(cylinder_in_box(3, 8, false), {size, tolerance});
      settles(cylinder_in_box(3, 8, true), {size, tolerance});
    }
}

TEST(RepeatedCalls, OnABall) {
  for (const double tolerance : {0.05, 0.01, 0.002})
    for (const double size : {0.0, 0.25, 0.5}) {
      SCOPED_TRACE("tolerance " + std::to_string(tolerance) + ", size " + std::to_string(size));
      settles(ball(10), {size, tolerance});
    }
}

/// The test uses uniform sizes. The mesh's own sizes grow so fast around the tube that limiting
/// their growth makes them smaller with each call, even without a tolerance.
TEST(RepeatedCalls, OnATorus) {
  for (const double tolerance : {0.05, 0.01})
    for (const double size : {0.4, 1.0}) {
      SCOPED_TRACE("tolerance " + std::to_string(tolerance) + ", size " + std::to_string(size));
      settles(bent_tube(10, 4), {size, tolerance});
    }
}

/// Layers across the axis of a cylinder that are thinner than the tolerance. Its facets are farther
/// from the circle than that and can hardly change.
TEST(RepeatedCalls, ComeToThinLayersAlongACylinder) {
  for (const double thin : {0.001, 0.002}) {
    SCOPED_TRACE("thin " + std::to_string(thin));
    AdaptOptions options;
    options.make.hausdorff_tolerance = 2 * thin;
    AnyMesh mesh = cylinder_in_box(3, 8, true);
    for (int call = 0; call < 2; ++call) {
      const AnyField metric = test::metric_field<3>(mesh, [&](std::uint32_t v) {
        const double height = thin + 0.2 * std::abs(mesh.coordinates[3 * v + 2] - 0.5);
        return Metric<3>{{25, 0, 25, 0, 0, 1 / (height * height)}};
      });
      const AdaptedMesh result = adapt(executor, mesh, metric, options);
      const MeshStatistics found = measure(executor, result.mesh, &result.metric);
      EXPECT_GT(found.quality.low, 0.4);
      EXPECT_LT(found.edge_length.max, 8);
      mesh = result.mesh;
    }
  }
}

/// Sizes that differ by 1e6 to 1e8 in one body, which is thinner than the larger ones: the first
/// call must come to the lengths asked for, instead of leaving edges for the next ones to split.
TEST(RepeatedCalls, ComeToExtremeStretchAtOnce) {
  Random random(11);
  for (int trial = 0; trial < 40; ++trial) {
    const int dimension = 2 + trial % 2;
    AnyMesh mesh = test::make_grid(test::unit_grid(
        dimension, 3 + static_cast<int>(test::below(random, dimension == 2 ? 4 : 1))));
    test::jiggle(mesh, random, 0.2);
    const double ratio = std::pow(10, test::uniform(random, 6, 8));
    const double size = 1 / test::uniform(random, 5, dimension == 2 ? 60 : 15);
    SCOPED_TRACE("trial " + std::to_string(trial) + ", ratio " + std::to_string(ratio) + ", size " +
                 std::to_string(size));
    const auto metric_on = [&](const AnyMesh& at) {
      const double fine = 1 / (size * size), coarse = fine / (ratio * ratio);
      return dimension == 2 ? test::metric_field<2>(at,
                                                    [&](std::uint32_t) {
                                                      return Metric<2>{{fine, 0, coarse}};
                                                    })
                            : test::metric_field<3>(at, [&](std::uint32_t) {
                                return Metric<3>{{fine, 0, coarse, 0, 0, coarse}};
                              });
    };
    std::size_t first = 0;
    for (int call = 0; call < 3; ++call) {
      const AdaptedMesh result = adapt(executor, mesh, metric_on(mesh));
      const MeshStatistics found = measure(executor, result.mesh, &result.metric);
      mesh = result.mesh;
      if (call == 0) first = element_count(mesh);
      EXPECT_LT(static_cast<double>(found.edges_long),
                0.5 * static_cast<double>(found.edge_length.count))
          << "call " << call;
    }
    EXPECT_LT(static_cast<double>(element_count(mesh)), 1.5 * static_cast<double>(first + 50));
  }
}

TEST(RepeatedCalls, OnAFewElements) {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const int dimension = 2 + trial % 2;
    AnyMesh mesh = random_mesh(dimension, random);
    const double tolerance = std::pow(10.0, test::uniform(random, -4, -1));
    const double size = test::chance(random, 0.5) ? 0 : test::uniform(random, 0.08, 0.5);
    SCOPED_TRACE("trial " + std::to_string(trial) + ", " + std::to_string(element_count(mesh)) +
                 " elements, tolerance " + std::to_string(tolerance) + ", size " +
                 std::to_string(size));
    settles(std::move(mesh), {size, tolerance});
  }
}

}  // namespace
}  // namespace ductile::meshadapt::repeated_calls_test
