/// @file
/// Adapts surfaces alone: triangles in space without tetrahedra.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/bits.hpp"
#include "support/trials.hpp"
#include "surface_support.hpp"

namespace ductile::meshadapt::surface_test {
namespace {

using runtime::Executor;
using namespace surface_support;

/// Adapts to a size, and checks what holds of all results.
AdaptedMesh adapted_to(const AnyMesh& mesh, const AnyField& metric, const AdaptOptions& options) {
  AdaptedMesh adapted = adapt(two(), mesh, metric, options);
  const auto faults = check_adapted(two(), mesh, adapted.mesh, options.make.hausdorff_tolerance);
  EXPECT_TRUE(faults.empty()) << faults.front();
  EXPECT_EQ(adapted.mesh.dimension, 3);
  EXPECT_EQ(adapted.mesh.tetrahedra.size(), 0U);
  return adapted;
}
AdaptedMesh adapted_to(const AnyMesh& mesh, double size, const AdaptOptions& options) {
  return adapted_to(mesh, constant_metric(mesh, size), options);
}

double worst_quality(const AnyMesh& mesh) {
  const auto quality = element_qualities(two(), mesh, nullptr);
  return *std::min_element(quality.begin(), quality.end());
}

// ---- Tests ----

TEST(Surface, OfASphereStaysRound) {
  for (const double size : {0.07, 0.2}) {
    SCOPED_TRACE(size);
    const AdaptedMesh adapted = adapted_to(sphere(24), size, within(size / 20));
    EXPECT_EQ(euler(adapted.mesh), 2);
    EXPECT_EQ(rims(adapted.mesh) + non_manifold(adapted.mesh), 0);
    EXPECT_NEAR(volume(adapted.mesh) / (4 * std::numbers::pi / 3), 1, 0.02);
    EXPECT_GT(worst_quality(adapted.mesh), 0.35);
    EXPECT_GT(measure(two(), adapted.mesh, &adapted.metric).share_in_range(), 0.9);
  }
}

TEST(Surface, OfACylinderKeepsItsRims) {
  const AdaptedMesh adapted = adapted_to(cylinder(40, true), 0.12, within(0.004));
  EXPECT_EQ(euler(adapted.mesh), 2);
  EXPECT_EQ(rims(adapted.mesh) + non_manifold(adapted.mesh), 0);
  EXPECT_NEAR(volume(adapted.mesh) / (std::numbers::pi / 2), 1, 0.01);
  EXPECT_GT(worst_quality(adapted.mesh), 0.35);
  for (std::size_t t = 0; t < adapted.mesh.triangles.size(); ++t)
    for (const std::uint32_t v : adapted.mesh.triangles.vertices[t])
      if (adapted.mesh.triangles.reference[t] > 1) {
        EXPECT_NEAR(at(adapted.mesh, v)[2], adapted.mesh.triangles.reference[t] == 2 ? 0 : 2, 1e-9);
      }
}

TEST(Surface, ThatIsOpenKeepsItsRim) {
  const AnyMesh mesh = hemisphere(16);
  const AdaptedMesh adapted = adapted_to(mesh, 0.15, within(0.004));
  EXPECT_EQ(euler(adapted.mesh), euler(mesh));
  EXPECT_NEAR(rims(adapted.mesh) / rims(mesh), 1, 0.01);
  EXPECT_GT(worst_quality(adapted.mesh), 0.35);
}

TEST(Surface, OfThreeSheetsKeepsTheLineWhereTheyMeet) {
  const AnyMesh mesh = three_sheets(8);
  for (const double size : {0.05, 0.4})
    for (const double tolerance : {0.0, 0.01}) {
      SCOPED_TRACE(std::to_string(size) + " " + std::to_string(tolerance));
      const AdaptedMesh adapted = adapted_to(mesh, size, within(tolerance));
      EXPECT_NEAR(non_manifold(adapted.mesh), 1, 1e-12);
      EXPECT_NEAR(rims(adapted.mesh), rims(mesh), 1e-9);
      for (const auto& [reference, area] : areas(adapted.mesh))
        EXPECT_NEAR(area, areas(mesh).at(reference), 1e-9);
    }
}

/// A flat square in a plane that is not one of the axes'.
TEST(Surface, ThatIsFlatIsAsGoodAsInThePlane) {
  const auto in_plane = [](double u, double v) {
    return u * Vector<3>{{0.6, 0.64, 0.48}} + v * Vector<3>{{-0.8, 0.48, 0.36}};
  };
  AnyMesh mesh = sheet(10, 10, in_plane), flat = mesh;
  flat.dimension = 2;
  flat.coordinates.clear();
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 10; ++i)
      for (const int k : {i, j}) flat.coordinates.push_back(k / 10.0);
  AdaptOptions options;
  options.make.complete_boundary = true;
  const AdaptedMesh here = adapted_to(mesh, 0.04, {});
  const AdaptedMesh there = adapt(two(), flat, constant_metric(flat, 0.04), options);
  const auto mean = [](const AdaptedMesh& adapted) {
    return measure(two(), adapted.mesh, &adapted.metric).quality.mean;
  };
  EXPECT_NEAR(areas(here.mesh)[1], 1, 1e-12);
  EXPECT_NEAR(rims(here.mesh), 4, 1e-12);
  EXPECT_NEAR(mean(here), mean(there), 0.01);
  EXPECT_NEAR(static_cast<double>(here.mesh.triangles.size()) /
                  static_cast<double>(there.mesh.triangles.size()),
              1, 0.05);
}

/// Ten times as long along the axis, on an open cylinder.
TEST(Surface, FollowsAnAnisotropicMetric) {
  const AnyMesh mesh = cylinder(48, false);
  AnyField metric = constant_metric(mesh, 0.03);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) metric.values[6 * v + 5] /= 100;
  const AdaptedMesh adapted = adapted_to(mesh, metric, within(0.005));
  const MeshStatistics statistics = measure(two(), adapted.mesh, &adapted.metric);
  EXPECT_GT(statistics.share_in_range(), 0.85);
  EXPECT_GT(statistics.quality.mean, 0.85);
}

TEST(Surface, IsTheSameAtAnyNumberOfThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh mesh = cylinder(40, true);
  const AnyField metric = constant_metric(mesh, 0.05);
  const auto on = [&](int threads) {
    return adapt(Executor({.threads = threads}), mesh, metric, within(0.004));
  };
  const AdaptedMesh first = on(1);
  for (const int threads : test::thread_counts) {
    SCOPED_TRACE(threads);
    const AdaptedMesh other = on(threads);
    EXPECT_EQ(other.mesh, first.mesh);
    EXPECT_EQ(test::bits(other.metric.values), test::bits(first.metric.values));
  }
}

TEST(Surface, OfAScanIsMended) {
  AnyMesh mesh = sphere(16);
  std::mt19937 random(3);
  for (auto& corners : mesh.triangles.vertices)
    if (random() % 10 == 0) std::swap(corners[0], corners[1]);
  const auto first = mesh.triangles.vertices[0], second = mesh.triangles.vertices[1];
  mesh.triangles.add(first, 1);
  mesh.triangles.add({second[0], second[0], second[1]}, 1);
  const AdaptedMesh adapted = adapt(two(), mesh, constant_metric(mesh, 0.2), within(0.01));
  EXPECT_EQ(euler(adapted.mesh), 2);
  EXPECT_NEAR(std::abs(volume(adapted.mesh)) / (4 * std::numbers::pi / 3), 1, 0.05);
  std::string all;
  for (const std::string& warning : adapted.report.warnings) all += warning + "\n";
  for (const char* said : {"have no area", "are listed twice", "were turned"})
    EXPECT_NE(all.find(said), std::string::npos) << all;
}

/// A Moebius strip has one side only.
TEST(Surface, OfOneSideIsAdapted) {
  const auto strip = [](double u, double v) {
    const double a = 2 * std::numbers::pi * u, r = 1 + 0.4 * (v - 0.5) * std::cos(a / 2);
    return Vector<3>{{r * std::cos(a), r * std::sin(a), 0.4 * (v - 0.5) * std::sin(a / 2)}};
  };
  const AnyMesh mesh = welded({sheet(60, 4, strip)});
  ASSERT_EQ(euler(mesh), 0);
  const AdaptedMesh adapted = adapted_to(mesh, 0.08, within(0.005));
  EXPECT_EQ(euler(adapted.mesh), 0);
  EXPECT_EQ(non_manifold(adapted.mesh), 0);
}

/// However often it is adapted, also from coarse to fine.
TEST(Surface, StaysOnItsGeometry) {
  AdaptOptions options = within(0.01);
  const AnyMesh first = hemisphere(32);
  options.make.geometry = std::make_shared<const Geometry>(
      two(), first, GeometryOptions{.tolerance = options.make.hausdorff_tolerance});
  AnyMesh mesh = first;
  for (const double size : {0.3, 0.08, 0.25, 0.08}) {
    SCOPED_TRACE(size);
    mesh = adapted_to(mesh, size, options).mesh;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      ASSERT_NEAR(norm(at(mesh, v)), 1, 0.003);
    EXPECT_NEAR(rims(mesh), 2 * std::numbers::pi, 0.06);
  }
  EXPECT_NEAR(areas(mesh)[1], 2 * std::numbers::pi, 0.02);
  AnyMesh other = sphere(8);
  for (double& x : other.coordinates) x += 3;
  EXPECT_THROW(adapt(two(), other, constant_metric(other, 0.1), options), InputError);
}

TEST(Surface, KeepsWhatIsRequired) {
  AnyMesh mesh = sphere(24);
  mesh.required_vertices = {7, 100};
  mesh.required_triangles = {200, 201};
  const AdaptedMesh adapted = adapted_to(mesh, 0.3, within(0.02));
  ASSERT_EQ(adapted.mesh.required_triangles.size(), 2U);
  const auto has = [&](const Vector<3>& point) {
    for (std::uint32_t v = 0; v < adapted.mesh.vertex_count(); ++v)
      if (at(adapted.mesh, v) == point) return true;
    return false;
  };
  for (const std::uint32_t v : mesh.required_vertices) EXPECT_TRUE(has(at(mesh, v)));
  for (const std::uint32_t t : mesh.required_triangles)
    for (const std::uint32_t v : mesh.triangles.vertices[t]) EXPECT_TRUE(has(at(mesh, v)));
}

/// Walls that are thinner than the tolerance, with free and with locked rims.
TEST(Surface, ThatIsThinDoesNotMeetItself) {
  for (const bool lock : {false, true})
    for (const double thickness : {0.01, 0.04}) {
      SCOPED_TRACE(thickness);
      const auto side = [&](double z, bool turned) {
        return sheet(5, 5, [=](double u, double v) {
          const double x = turned ? v : u, y = turned ? u : v;
          return Vector<3>{{x, y, z + 0.1 * std::sin(4 * x)}};
        });
      };
      const AnyMesh mesh = welded({side(0, true), side(thickness, false)});
      AdaptOptions options = within(0.07);
      options.make.lock_boundary = lock;
      const AdaptedMesh adapted = adapted_to(mesh, 0.06, options);
      EXPECT_EQ(euler(adapted.mesh), euler(mesh));
    }
}

/// Random sizes, folds, holes and noise: all results are valid.
TEST(Surface, IsValidHoweverItIs) {
  for (unsigned seed = 1; seed <= test::trials(20); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double a = uniform(0, 0.3), b = uniform(2, 9), c = uniform(0, 0.2), noise = uniform(0, 1);
    const bool closed = seed % 3 != 0;
    const int n = 8 + static_cast<int>(random() % 20);
    const auto bumpy = [&](double u, double v) {
      const Vector<3> p = closed ? on_sphere(u, v) : Vector<3>{{2 * u, 2 * v, 0}};
      const double h = a * std::sin(b * p[0]) * std::cos(b * p[1]) + c * std::sin(2 * b * p[0]);
      return closed ? (1 + h) * p : p + Vector<3>{{0, 0, h}};
    };
    AnyMesh mesh = welded({sheet(closed ? 2 * n : n, n, bumpy, closed)});
    const double size = uniform(0.05, 0.6), tolerance = seed % 4 == 0 ? 0 : uniform(0.002, 0.05);
    if (seed % 2 == 0)
      for (double& x : mesh.coordinates) x += uniform(-1, 1) * noise * tolerance / 3;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      mesh.triangles.reference[t] = at(mesh, mesh.triangles.vertices[t][0])[1] > 0.3 ? 1 : 2;
    if (seed % 5 == 0)  // holes
      for (std::size_t t = 7; t < mesh.triangles.size(); t += 31)
        mesh.triangles.vertices[t] = mesh.triangles.vertices[t - 1];
    const AdaptedMesh adapted = adapt(two(), mesh, constant_metric(mesh, size), within(tolerance));
    EXPECT_TRUE(check_mesh(two(), adapted.mesh).empty());
    EXPECT_EQ(non_manifold(adapted.mesh), 0);
    EXPECT_EQ(areas(adapted.mesh).size(), areas(mesh).size());
  }
}

}  // namespace
}  // namespace ductile::meshadapt::surface_test
