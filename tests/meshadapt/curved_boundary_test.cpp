/// @file
/// Adapts meshes with curved boundaries that may change within a tolerance.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/unit.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::curved_boundary_test {
namespace {

using runtime::Executor;

/// An arc, flat at its ends and in 3D above and below.
AnyMesh arc(int dimension, int n, double angle) {
  test::Grid grid = test::unit_grid(dimension, n);
  AnyMesh mesh = test::make_grid(grid);
  test::bend(mesh, angle);
  return mesh;
}

/// Least and greatest distance from the z axis of sample points of the facets with a reference.
template <int Dim>
std::array<double, 2> radii_in(const AnyMesh& mesh, std::int32_t reference) {
  std::array<double, 2> radii{1e9, 0};
  const auto& facets = test::facets<Dim>(mesh);
  const auto look = [&](const Vector<Dim>& p) {
    const double radius = std::hypot(p[0], p[1]);
    radii = {std::min(radii[0], radius), std::max(radii[1], radius)};
  };
  constexpr int n = 12;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (facets.reference[f] != reference) continue;
    const auto corner = [&](std::size_t i) {
      return test::point<Dim>(mesh, facets.vertices[f][i]);
    };
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        look((1.0 / n) * (i * corner(0) + j * corner(1) + (n - i - j) * corner(Dim - 1)));
  }
  return radii;
}
std::array<double, 2> radii(const AnyMesh& mesh, std::int32_t reference) {
  return mesh.dimension == 2 ? radii_in<2>(mesh, reference) : radii_in<3>(mesh, reference);
}

std::size_t facets_on_arcs(const AnyMesh& mesh) {
  const auto& references = mesh.dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
  return static_cast<std::size_t>(
      std::count_if(references.begin(), references.end(), [](int r) { return r == 1 || r == 2; }));
}

class CurvedBoundary : public testing::TestWithParam<int> {
 protected:
  int dimension() const { return GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, CurvedBoundary, testing::Values(2, 3),
                         [](const auto& at) { return std::to_string(at.param) + "D"; });

TEST_P(CurvedBoundary, IsCoarsenedWithinTheTolerance) {
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 60 : 14, 2);
  const Executor executor({.threads = 2});
  for (const double tolerance : {0.05, 0.02}) {
    SCOPED_TRACE(tolerance);
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance;
    const AnyField metric = constant_metric(mesh, dimension() == 2 ? 0.15 : 0.3);
    const AdaptedMesh result = adapt(executor, mesh, metric, options);
    EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
    EXPECT_EQ(test::joined(check_domain(executor, mesh, result.mesh, tolerance)), "");
    for (const int reference : {1, 2}) {
      const auto before = radii(mesh, reference), after = radii(result.mesh, reference);
      EXPECT_GE(after[0], before[0] - tolerance);
      EXPECT_LE(after[1], before[1] + tolerance);
    }
    const MeshStatistics found = measure(executor, result.mesh, &result.metric);
    EXPECT_GT(found.share_in_range(), 0.93);
    EXPECT_GT(found.quality.min, 0.4);
    const AdaptedMesh kept = adapt(executor, mesh, metric);
    EXPECT_EQ(test::joined(test::faults_of(executor, mesh, kept)), "");
    EXPECT_LT(facets_on_arcs(result.mesh), facets_on_arcs(kept.mesh));
    EXPECT_LT(measure(executor, kept.mesh, &kept.metric).share_in_range(),
              found.share_in_range() - 0.02);
  }
}

std::set<std::array<std::uint32_t, 2>> edges_on_arcs(const AnyMesh& mesh) {
  std::set<std::array<std::uint32_t, 2>> edges;
  const auto add = [&](const auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (const std::uint32_t a : facets.vertices[f])
        for (const std::uint32_t b : facets.vertices[f])
          if (a < b && (facets.reference[f] == 1 || facets.reference[f] == 2)) edges.insert({a, b});
  };
  mesh.dimension == 2 ? add(mesh.edges) : add(mesh.triangles);
  return edges;
}

TEST_P(CurvedBoundary, IsReportedByItsEdges) {
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 40 : 8, 2);
  const Executor executor({.threads = 2});
  AdaptOptions options;
  for (const double tolerance : {0.0, 1e-4}) {
    options.make.hausdorff_tolerance = tolerance;
    for (const double size : {1e-9, 1e9}) {  // all edges are long, or short
      options.iterations = 1;
      options.insert = false;
      const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, size), options);
      const std::size_t count = tolerance > 0 ? edges_on_arcs(result.mesh).size() : 0;
      EXPECT_EQ(result.report.curved_edges, count);
      EXPECT_EQ(result.report.curved_edges_short, size > 1 ? count : 0);
    }
  }
}

TEST_P(CurvedBoundary, MayBeListedInAnyDirection) {
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 40 : 8, 1.5);
  AnyMesh turned = mesh;
  for (std::size_t f = 0; f < turned.edges.size(); f += 2)
    std::swap(turned.edges.vertices[f][0], turned.edges.vertices[f][1]);
  if (dimension() == 3)
    for (std::size_t f = 0; f < turned.triangles.size(); f += 2)
      std::swap(turned.triangles.vertices[f][0], turned.triangles.vertices[f][1]);
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.03;
  const Executor executor({.threads = 1});
  const AnyField metric = constant_metric(mesh, 0.4);
  EXPECT_EQ(test::bits(adapt(executor, mesh, metric, options).mesh.coordinates),
            test::bits(adapt(executor, turned, metric, options).mesh.coordinates));
}

TEST_P(CurvedBoundary, IsRefinedOnItsFacets) {
  const AnyMesh mesh = arc(dimension(), 4, 1.5);
  const Executor executor({.threads = 2});
  AdaptOptions options;
  options.make.hausdorff_tolerance = 1e-3;
  const AnyField metric = constant_metric(mesh, dimension() == 2 ? 0.02 : 0.08);
  const AdaptedMesh result = adapt(executor, mesh, metric, options);
  EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
  EXPECT_EQ(test::joined(check_domain(executor, mesh, result.mesh, 1e-3)), "");
  const MeshStatistics found = measure(executor, result.mesh, &result.metric);
  EXPECT_GT(found.share_in_range(), 0.9);
}

/// Flat parts stay where they are, up to rounding.
TEST_P(CurvedBoundary, KeepsWhatIsFlat) {
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 40 : 10, 1.5);
  const Executor executor({.threads = 2});
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.03;
  const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, 0.3), options);
  const auto farthest = [&](const AnyMesh& of, std::size_t axis, std::int32_t reference) {
    const auto size = static_cast<std::size_t>(of.dimension);
    double most = 0;
    const auto look = [&](const auto& facets) {
      for (std::size_t f = 0; f < facets.size(); ++f)
        for (const std::uint32_t v : facets.vertices[f])
          if (facets.reference[f] == reference)
            most = std::max(most, std::abs(of.coordinates[v * size + axis]));
    };
    dimension() == 2 ? look(of.edges) : look(of.triangles);
    return most;
  };
  EXPECT_NEAR(farthest(result.mesh, 1, 3), 0, 1e-12) << "the end on the x axis";
  if (dimension() == 3) {
    EXPECT_NEAR(farthest(result.mesh, 2, 5), 0, 1e-12) << "underneath";
  }
  EXPECT_NEAR(farthest(result.mesh, 0, 3), 1.5, 1e-12) << "a corner";
  EXPECT_GT(farthest(mesh, 0, 4), 0.1) << "the other end is oblique";
  EXPECT_NEAR(farthest(result.mesh, 0, 4), farthest(mesh, 0, 4), 1e-12);
}

/// Two arcs, one around the other, meet at one end only. Nothing may close the gap.
TEST_P(CurvedBoundary, DoesNotCrossANarrowGap) {
  test::Grid grid = test::unit_grid(dimension(), dimension() == 2 ? 24 : 10);
  grid.lines[0] = {0, 0.2, 0.4, 0.41, 0.6, 0.8, 1};
  grid.region = [](const test::Cell& cell) { return cell[0] == 2 && cell[1] != 0 ? 0 : 1; };
  AnyMesh mesh = test::make_grid(grid);
  // Gives the walls of the gap references of their own.
  const auto in_gap = [&](const auto& vertices) {
    const auto size = static_cast<std::size_t>(dimension());
    return std::all_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
      const double x = mesh.coordinates[v * size];
      return x > 0.39 && x < 0.42;
    });
  };
  const auto rename = [&](auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      if (in_gap(facets.vertices[f]) && facets.reference[f] <= 2) facets.reference[f] += 20;
  };
  dimension() == 2 ? rename(mesh.edges) : rename(mesh.triangles);
  test::bend(mesh, 2.5);
  const Executor executor({.threads = 2});
  for (const double tolerance : {0.006, 0.02, 0.2}) {
    SCOPED_TRACE(tolerance);
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance;
    const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, 0.4), options);
    EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
    EXPECT_EQ(test::joined(check_boundary(executor, result.mesh)), "");
  }
}

/// Largest difference between `radius` and the distance from the axis of vertices of facets with a
/// reference.
template <int Dim>
double vertices_off(const AnyMesh& mesh, std::int32_t reference, double radius) {
  const auto& facets = test::facets<Dim>(mesh);
  double most = 0;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (const std::uint32_t v : facets.vertices[f]) {
      const Vector<Dim> p = test::point<Dim>(mesh, v);
      if (facets.reference[f] == reference)
        most = std::max(most, std::abs(std::hypot(p[0], p[1]) - radius));
    }
  return most;
}

/// Each call adapts the result of the previous one, to sizes that are small elsewhere.
TEST_P(CurvedBoundary, StaysWhereItIsInManyCalls) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  constexpr double tolerance = 4e-3;
  constexpr int calls = 10;
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 40 : 14, 1.5);
  const auto at_first = std::array{radii(mesh, 1), radii(mesh, 2)};
  const Executor executor({.threads = 2});
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  AnyMesh now = mesh;
  for (int call = 0; call < calls; ++call) {
    AnyField metric = constant_metric(now, 1);
    const auto stride = static_cast<std::size_t>(dimension());
    const std::size_t components = metric.values.size() / now.vertex_count();
    for (std::size_t v = 0; v < now.vertex_count(); ++v) {
      const double angle = std::atan2(now.coordinates[v * stride + 1], now.coordinates[v * stride]);
      const double away = std::abs(angle - 1.5 * call / (calls - 1));
      const double size = 0.06 + 0.2 * std::min(1.0, away);
      for (std::size_t i = 0; i < components; ++i) metric.values[v * components + i] /= size * size;
    }
    now = adapt(executor, now, metric, options).mesh;
    EXPECT_EQ(test::joined(check_mesh(executor, now)), "");
  }
  for (const int reference : {1, 2}) {
    const double radius = at_first[static_cast<std::size_t>(reference - 1)][1];
    EXPECT_LT(dimension() == 2 ? vertices_off<2>(now, reference, radius)
                               : vertices_off<3>(now, reference, radius),
              0.5 * tolerance);
    const auto after = radii(now, reference);
    EXPECT_GT(after[0], radius - 1.3 * tolerance);
    EXPECT_LT(after[1], radius + 0.5 * tolerance);
  }
}

TEST_P(CurvedBoundary, GivesTheSameBytesAtEachThreadCount) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh mesh = arc(dimension(), dimension() == 2 ? 50 : 12, 2);
  test::Random random(3);
  AnyField metric = test::layer_field(mesh, random, 0.2);
  test::scale_to(metric, mesh, dimension() == 2 ? 100 : 60);
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.02;
  const AdaptedMesh first = adapt(Executor({.threads = 1}), mesh, metric, options);
  for (const int threads : test::thread_counts) {
    const AdaptedMesh other = adapt(Executor({.threads = threads}), mesh, metric, options);
    EXPECT_EQ(test::bits(first.mesh.coordinates), test::bits(other.mesh.coordinates));
    EXPECT_EQ(first.mesh.edges.vertices, other.mesh.edges.vertices);
    EXPECT_EQ(first.mesh.triangles.vertices, other.mesh.triangles.vertices);
    EXPECT_EQ(first.mesh.tetrahedra.vertices, other.mesh.tetrahedra.vertices);
  }
}

/// Largest angle, in degrees, between consecutive edges with a reference, in 2D.
double greatest_turn(const AnyMesh& mesh, std::int32_t reference) {
  std::map<std::uint32_t, std::vector<Vector<2>>> away;  // [vertex], directions of its edges
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edges.reference[e] != reference) continue;
    const auto [a, b] = mesh.edges.vertices[e];
    const Vector<2> along = unit(test::point<2>(mesh, b) - test::point<2>(mesh, a));
    away[a].push_back(along);
    away[b].push_back(-1.0 * along);
  }
  double least = 1;
  for (const auto& [vertex, edges] : away)
    if (edges.size() == 2) least = std::min(least, -dot(edges[0], edges[1]));
  return std::acos(least) * 180 / std::numbers::pi;
}

/// Arcs of ellipses, some with radii of only 4 tolerances, and sizes that change from call to call.
TEST(CurvedBoundaries, AreSmoothForTheNextCallIfTheyWere) {
  const Executor executor({.threads = 2});
  test::Random random(4);
  for (int trial = 0; trial < 12; ++trial) {
    AnyMesh mesh = arc(2, 60, test::uniform(random, 1, 2.8));
    const double flat = test::uniform(random, 0.6, 1);
    for (std::size_t i = 1; i < mesh.coordinates.size(); i += 2) mesh.coordinates[i] *= flat;
    AdaptOptions options;
    options.make.ridge_angle = trial % 3 == 2 ? 30 : 45;
    options.make.hausdorff_tolerance = 0.5 * flat * flat / test::uniform(random, 4, 13);
    if (trial % 2 == 1) options.gradation = 1.5;
    for (int call = 0; call < 6; ++call) {
      SCOPED_TRACE("trial " + std::to_string(trial) + ", call " + std::to_string(call));
      AnyField sizes{2, mesh.vertex_count(), {AnyField::Type::scalar}, {}, "sizes"};
      const double front = test::uniform(random, -0.5, 1.5);
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        sizes.values.push_back(0.1 + 0.4 * std::abs(test::point<2>(mesh, v)[0] - front));
      mesh = adapt(executor, mesh, metric_of(sizes, mesh, {}), options).mesh;
      for (const int reference : {1, 2})
        EXPECT_LT(greatest_turn(mesh, reference), options.make.ridge_angle);
    }
  }
}

double volume_of(const AnyMesh& mesh) {
  double volume = 0;
  for (const auto& corners : mesh.tetrahedra.vertices) {
    std::array<Vector<3>, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = test::point<3>(mesh, corners[i]);
    volume += dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
  }
  return volume;
}

/// A part of a shell, one cell thick, with an outer radius of 1: a bowl around its axis, or a
/// piece between two angles from it.
AnyMesh shell(int n, double thickness, bool is_bowl) {
  test::Grid grid = test::unit_grid(3, n);
  grid.lines[2] = {0, 1};
  AnyMesh mesh = test::make_grid(grid);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3) {
    double* p = &mesh.coordinates[at];
    const double radius = 1 - thickness * (1 - p[2]), x = 2 * p[0] - 1, y = 2 * p[1] - 1;
    const double turn = is_bowl ? std::atan2(y, x) : 2.1 * p[1];
    const double angle = is_bowl ? 1.4 * std::max(std::abs(x), std::abs(y)) : 0.5 + 2.1 * p[0];
    p[0] = radius * std::sin(angle) * std::cos(turn);
    p[1] = radius * std::sin(angle) * std::sin(turn);
    p[2] = radius * std::cos(angle);
  }
  return mesh;
}

/// Elements of a thin wall become flatter where it is coarsened.
TEST(CurvedBoundaries, OfThinShellsAreCoarsened) {
  test::Random random(56);
  const Executor executor({.threads = 2});
  for (int trial = 0; trial < (test::sanitized ? 1 : 4); ++trial) {
    const double thickness = test::uniform(random, 0.015, 0.03);
    const AnyMesh mesh = shell(30, thickness, trial % 2 == 1);
    AdaptOptions options;
    options.make.hausdorff_tolerance = test::uniform(random, 0.01, 0.02);
    SCOPED_TRACE("trial " + std::to_string(trial) + ", thickness " + std::to_string(thickness) +
                 ", tolerance " + std::to_string(options.make.hausdorff_tolerance));
    const AnyMesh result = adapt(executor, mesh, coarsest_metric(mesh, 0.6), options).mesh;
    EXPECT_LT(result.tetrahedra.size(), mesh.tetrahedra.size() / 2);
    EXPECT_GT(volume_of(result), 0.98 * volume_of(mesh));
    EXPECT_EQ(test::joined(check_mesh(executor, result)), "");
  }
}

/// The shells are thinner than a few tolerances, and the chords of their facets are about as far
/// off.
TEST(CurvedBoundaries, OfThinShellsLoseNothingInManyCalls) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  test::Random random(55);
  const Executor executor({.threads = 2});
  for (int trial = 0; trial < 6; ++trial) {
    const int n = 7 + static_cast<int>(test::below(random, 4));
    const bool is_bowl = trial % 2 == 1;
    const double edge = (is_bowl ? 2.8 : 2.1) / n, sag = edge * edge / 8;
    const double thickness = test::uniform(random, 2, 5) * sag;
    AdaptOptions options;
    options.curved_sizes = true;
    options.make.hausdorff_tolerance = test::uniform(random, 0.5, 1) * sag;
    SCOPED_TRACE("trial " + std::to_string(trial) + ", " + std::to_string(n) +
                 " cells, thickness " + std::to_string(thickness) + ", tolerance " +
                 std::to_string(options.make.hausdorff_tolerance));
    AnyMesh mesh = shell(n, thickness, is_bowl);
    const double first = volume_of(mesh);
    const std::size_t elements = mesh.tetrahedra.size();
    for (int call = 0; call < 3; ++call) {
      mesh = adapt(executor, mesh, coarsest_metric(mesh, 2), options).mesh;
      EXPECT_GT(volume_of(mesh), 0.995 * first) << "call " << call;
      EXPECT_LT(mesh.tetrahedra.size(), 2.5 * static_cast<double>(elements));
    }
    EXPECT_EQ(test::joined(check_mesh(executor, mesh)), "");
  }
}

TEST(CurvedBoundaries, ALidSmallerThanTheToleranceStays) {
  const Executor executor({.threads = 2});
  for (const double lid : {0.5, 0.02, 1e-4}) {
    SCOPED_TRACE(lid);
    const AnyMesh mesh = test::truncated_cone(6, lid);
    for (const bool move : {true, false}) {
      AdaptOptions options{.move = move};
      options.make.hausdorff_tolerance = 0.05;
      const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, 5), options);
      EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
      EXPECT_EQ(test::joined(check_domain(executor, mesh, result.mesh, 0.05)), "");
      EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size() / 2);
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::curved_boundary_test
