#include "ductile/meshadapt/geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "core/determinant.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::geometry_test {
namespace {

using runtime::Executor;

constexpr double radius = 0.5;

/// A disk or ball around the origin, made from the cells of a square or cube. Its boundary is one
/// piece, or four (3D: six), each with its own reference.
AnyMesh ball(int dimension, int n, bool in_one_piece) {
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension, n));
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    double* const x = &mesh.coordinates[d * v];
    double most = 0, square = 0;
    for (std::size_t i = 0; i < d; ++i) {
      x[i] = 2 * x[i] - 1;
      most = std::max(most, std::abs(x[i]));
      square += x[i] * x[i];
    }
    if (square > 0)
      for (std::size_t i = 0; i < d; ++i) x[i] *= radius * most / std::sqrt(square);
  }
  auto& references = dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
  if (in_one_piece) std::fill(references.begin(), references.end(), 1);
  return mesh;
}

double norm_of(const AnyMesh& mesh, std::size_t vertex) {
  double square = 0;
  const auto d = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t i = 0; i < d; ++i) square += std::pow(mesh.coordinates[d * vertex + i], 2);
  return std::sqrt(square);
}

double norm_in_plane(const AnyMesh& mesh, std::size_t vertex) {
  return std::hypot(mesh.coordinates[3 * vertex], mesh.coordinates[3 * vertex + 1]);
}

/// Largest distance of boundary vertices from the sphere.
double off_sphere(const AnyMesh& mesh) {
  std::set<std::uint32_t> boundary;
  const auto add = [&](const auto& facets) {
    for (const auto& facet : facets.vertices) boundary.insert(facet.begin(), facet.end());
  };
  mesh.dimension == 2 ? add(mesh.edges) : add(mesh.triangles);
  double most = 0;
  for (const std::uint32_t v : boundary) most = std::max(most, std::abs(norm_of(mesh, v) - radius));
  return most;
}

/// Volume times the factorial of the dimension.
template <int Dim>
double scaled_volume_in(const AnyMesh& mesh) {
  double sum = 0;
  for (const auto& corners : test::elements<Dim>(mesh).vertices) {
    std::array<Vector<Dim>, Dim + 1> points;
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = test::point<Dim>(mesh, corners[i]);
    sum += plain_determinant(points);
  }
  return sum;
}
double volume_of(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? scaled_volume_in<2>(mesh) : scaled_volume_in<3>(mesh);
}

/// Sizes with a front that moves from call to call.
AnyField front(const AnyMesh& mesh, int call) {
  AnyField sizes{mesh.dimension, mesh.vertex_count(), {AnyField::Type::scalar}, {}, "sizes"};
  const auto d = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double away = std::abs(mesh.coordinates[d * v] - 0.5 * std::cos(0.7 * call));
    sizes.values.push_back(std::min(0.2, 0.07 + 0.4 * away));
  }
  return metric_of(sizes, mesh, {});
}

class GeometryOf : public testing::TestWithParam<int> {
 protected:
  int dimension() const { return GetParam(); }
  static constexpr double tolerance = 0.004;
  AnyMesh start(bool in_one_piece) const {
    return ball(dimension(), dimension() == 2 ? 40 : 12, in_one_piece);
  }
  AdaptOptions options_on(const AnyMesh& mesh) const {
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance;
    options.make.geometry = std::make_shared<const Geometry>(
        Executor({.threads = 2}), mesh, GeometryOptions{.tolerance = tolerance});
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, GeometryOf, testing::Values(2, 3),
                         [](const auto& at) { return std::to_string(at.param) + "D"; });

TEST_P(GeometryOf, ABallKeepsItRoundInTenCalls) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const Executor executor({.threads = 2});
  for (const bool in_one_piece : {true, false}) {
    const AnyMesh first = start(in_one_piece);
    const AdaptOptions options = options_on(first);
    AnyMesh mesh = first;
    double at_first = 0;
    for (int call = 1; call <= 10; ++call) {
      const AdaptedMesh adapted = adapt(executor, mesh, front(mesh, call), options);
      EXPECT_EQ(test::joined(check_adapted(executor, mesh, adapted.mesh, tolerance)), "");
      mesh = adapted.mesh;
      const double now = volume_of(mesh);
      if (call == 1) at_first = now;
      EXPECT_NEAR(now / at_first, 1, dimension() == 2 ? 0.003 : 0.006) << "call " << call;
    }
    EXPECT_LT(off_sphere(mesh), 0.1 * tolerance);
  }
}

TEST_P(GeometryOf, ABallHasItsPointsAndNormals) {
  const Geometry geometry(Executor({.threads = 2}), start(true), {.tolerance = tolerance});
  EXPECT_EQ(geometry.dimension(), dimension());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    std::array<double, 3> direction{normal(random), normal(random),
                                    dimension() == 3 ? normal(random) : 0.0};
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    std::array<double, 3> point{};
    for (std::size_t k = 0; k < 3; ++k) point[k] = 0.52 * (direction[k] /= length);
    const auto found = geometry.closest(point, 0.1);
    ASSERT_TRUE(found);
    const auto& at = found->position;
    EXPECT_NEAR(std::hypot(at[0], at[1], at[2]), radius, 0.02 * tolerance);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(at[k], radius * direction[k], 0.25 * tolerance);
      EXPECT_NEAR(found->normal[k], direction[k], 0.02);
    }
    EXPECT_EQ(found->reference, 1);
    EXPECT_FALSE(geometry.closest(point, 0.01));
  }
}

TEST_P(GeometryOf, AnotherDomainIsRefused) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = start(true);
  const AdaptOptions options = options_on(mesh);
  const auto message = [&](const AnyMesh& other, const AdaptOptions& with) -> std::string {
    try {
      adapt(executor, other, constant_metric(other, 0.2), with);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  AnyMesh smaller = mesh;
  for (double& x : smaller.coordinates) x *= 0.95;
  EXPECT_NE(message(smaller, options).find("from the geometry"), std::string::npos);
  for (double& x : smaller.coordinates) x *= 0.1;
  EXPECT_NE(message(smaller, options).find("geometry of the same domain"), std::string::npos);
  const AnyMesh flat = ball(5 - dimension(), 8, true);
  EXPECT_NE(message(flat, options).find("dimension"), std::string::npos);
  AdaptOptions wider = options;
  wider.make.hausdorff_tolerance *= 2;
  EXPECT_NE(message(mesh, wider).find("hausdorff_tolerance"), std::string::npos);
  wider.make.hausdorff_tolerance = 0;
  EXPECT_NE(message(mesh, wider).find("hausdorff_tolerance"), std::string::npos);
}

TEST_P(GeometryOf, PartsNeedNoneOfItsCurves) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = start(true);
  AnyMesh inner = mesh;  // has no curved boundary near that of the geometry
  for (double& x : inner.coordinates) x *= 0.1;
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  options.make.geometry = std::make_shared<const Geometry>(
      executor, mesh, GeometryOptions{.tolerance = tolerance, .in_parts = true});
  EXPECT_NO_THROW(adapt(executor, inner, constant_metric(inner, 0.02), options));
}

/// The elements of a ball that touch its surface.
template <int Dim>
AnyMesh layer_of(const AnyMesh& mesh) {
  AnyMesh layer = mesh;
  Cells<Dim + 1>& elements = elements_in<Dim>(layer) = {};
  for (const Corners<Dim>& corners : elements_in<Dim>(mesh).vertices)
    if (std::any_of(corners.begin(), corners.end(),
                    [&](VertexId v) { return norm_of(mesh, v) > 0.99 * radius; }))
      elements.add(corners, 1);
  return layer;
}

TEST_P(GeometryOf, PartsMayHaveBeenCutFromTheirInside) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = start(true);
  const AnyMesh layer = dimension() == 2 ? layer_of<2>(mesh) : layer_of<3>(mesh);
  ASSERT_LT(layer.triangles.size() + layer.tetrahedra.size(),
            mesh.triangles.size() + mesh.tetrahedra.size());
  GeometryOptions options{.tolerance = tolerance};
  EXPECT_THROW(Geometry(executor, layer, options), InputError);
  options.in_parts = true;
  const Geometry whole(executor, mesh, options), cut(executor, layer, options);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    std::array<double, 3> point{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimension()); ++k)
      point[k] = 1.01 * mesh.coordinates[v * static_cast<std::size_t>(dimension()) + k];
    const auto a = whole.closest(point, 0.1), b = cut.closest(point, 0.1);
    ASSERT_EQ(a.has_value(), b.has_value()) << v;
    if (a) {
      EXPECT_EQ(a->position, b->position) << v;
    }
  }
}

TEST_P(GeometryOf, SizesAtCurvedBoundariesAreBoundedByTheTolerance) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = start(true);
  const AnyField metric = constant_metric(mesh, 1);
  const auto bounded = bound_at_curved_boundaries(executor, mesh, metric, options_on(mesh));
  const double chord = std::sqrt(8 * radius * tolerance);
  const auto each = static_cast<std::size_t>(dimension() == 2 ? 3 : 6);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double size = 1 / std::sqrt(bounded.values[v * each]);
    if (norm_of(mesh, v) < 0.99 * radius)
      EXPECT_EQ(size, 1) << v;
    else
      EXPECT_LT(size, 1.5 * chord) << v;
  }
}

TEST_P(GeometryOf, TheSameBallGivesTheSameBytesAtAnyNumberOfThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  const AnyMesh first = start(false);
  std::vector<std::uint64_t> expected;
  for (const int threads : {1, 2, 3, 4, 8}) {
    const Executor executor({.threads = threads});
    AdaptOptions options;
    options.make.hausdorff_tolerance = tolerance;
    options.make.geometry =
        std::make_shared<const Geometry>(executor, first, GeometryOptions{.tolerance = tolerance});
    AnyMesh mesh = first;
    for (int call = 1; call <= 2; ++call)
      mesh = adapt(executor, mesh, front(mesh, call), options).mesh;
    const auto found = test::bits(mesh.coordinates);
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected) << threads << " threads";
  }
}

TEST_P(GeometryOf, ABoxHasNothingThatIsCurved) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = test::make_grid(test::unit_grid(dimension(), 6));
  const AdaptOptions options = options_on(mesh);
  EXPECT_FALSE(options.make.geometry->closest({0.5, 0.5, 0}, 1));
  AdaptOptions without;
  without.make.hausdorff_tolerance = tolerance;
  const AnyField metric = constant_metric(mesh, 0.1);
  EXPECT_EQ(test::bits(adapt(executor, mesh, metric, options).mesh.coordinates),
            test::bits(adapt(executor, mesh, metric, without).mesh.coordinates));
}

/// A disk on top of a box has a reference of its own: its curve bends, but no patch does.
TEST(Geometry, OfACircleOnAFlatSideFitsItsMesh) {
  AnyMesh mesh = test::make_grid(test::unit_grid(3, 8));
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 3) {
    double &x = mesh.coordinates[at], &y = mesh.coordinates[at + 1];
    const double most = std::max(std::abs(x -= 0.5), std::abs(y -= 0.5)), far = std::hypot(x, y);
    const double round = far > 0 ? most / far : 1;
    const double scale = 1 + std::min(1.0, (0.5 - most) / 0.25) * (round - 1);
    x *= scale;
    y *= scale;
  }
  const auto is_inside = [&](std::uint32_t v) { return norm_in_plane(mesh, v) < 0.251; };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles.vertices[t];
    if (mesh.triangles.reference[t] == 6 && std::all_of(corners.begin(), corners.end(), is_inside))
      mesh.triangles.reference[t] = 9;
  }
  const Executor executor({.threads = 2});
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.01;
  options.make.geometry =
      std::make_shared<const Geometry>(executor, mesh, GeometryOptions{.tolerance = 0.01});
  const AdaptedMesh result = adapt(executor, mesh, constant_metric(mesh, 0.2), options);
  EXPECT_EQ(test::joined(check_adapted(executor, mesh, result.mesh, 0.01)), "");
  EXPECT_LT(result.mesh.triangles.size(), mesh.triangles.size());
}

/// A plate, thin or not, with a rough boundary of one reference, all of whose elements are valid.
AnyMesh rough_plate(int dimension, test::Random& random) {
  const auto d = static_cast<std::size_t>(dimension);
  for (;;) {
    AnyMesh mesh = test::make_grid(test::unit_grid(dimension, 2 + static_cast<int>(random() % 3)));
    const double thickness = std::pow(10, test::uniform(random, -1.5, 0));
    const double waves = test::uniform(random, 1, 8), height = test::uniform(random, 0, 0.2);
    const double rough = test::uniform(random, 0, 0.2);
    for (std::size_t at = 0; at < mesh.coordinates.size(); at += d) {
      double& top = mesh.coordinates[at + d - 1];
      top = thickness * (top + rough * test::uniform(random, -1, 1)) +
            height * std::sin(waves * mesh.coordinates[at]);
    }
    auto& references = dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
    std::fill(references.begin(), references.end(), 1);
    if (check_mesh(Executor({.threads = 1}), mesh).empty()) return mesh;
  }
}

TEST_P(GeometryOf, AnyMeshFitsItself) {
  const Executor executor({.threads = 1});
  test::Random random(5);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    const AnyMesh mesh = rough_plate(dimension(), random);
    AdaptOptions options;
    options.make.hausdorff_tolerance = std::pow(10, test::uniform(random, -3, -1));
    options.make.ridge_angle = test::uniform(random, 20, 89);
    options.make.geometry = std::make_shared<const Geometry>(
        executor, mesh,
        GeometryOptions{.tolerance = options.make.hausdorff_tolerance,
                        .ridge_angle = options.make.ridge_angle});
    AdaptedMesh adapted;
    ASSERT_NO_THROW(adapted = adapt(executor, mesh, constant_metric(mesh, 0.3), options));
    EXPECT_EQ(
        test::joined(check_adapted(executor, mesh, adapted.mesh, options.make.hausdorff_tolerance)),
        "");
    EXPECT_NO_THROW(adapt(executor, adapted.mesh, constant_metric(adapted.mesh, 0.2), options));
  }
}

/// A ball inside of a box, whose surface is an interface that is not listed, is cut by a plane, so
/// that the regions are those on its sides: nothing that is curved is left.
TEST_P(GeometryOf, ACutMeshMayHaveLostItsCurves) {
  const Executor executor({.threads = 2});
  test::Random random(9);
  const auto d = static_cast<std::size_t>(dimension());
  const int n = dimension() == 2 ? 16 : 8, quarter = n / 4;
  test::Grid grid = test::unit_grid(dimension(), n);
  grid.region = [&](const test::Cell& cell) {
    const auto is_inside = [&](int c) { return c >= quarter && c < n - quarter; };
    return std::all_of(cell.begin(), cell.begin() + dimension(), is_inside) ? 2 : 1;
  };
  AnyMesh mesh = test::make_grid(grid, false);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += d) {
    double most = 0, square = 0;
    for (std::size_t i = 0; i < d; ++i) {
      double& x = mesh.coordinates[at + i];
      x = 2 * x - 1;
      most = std::max(most, std::abs(x));
      square += x * x;
    }
    const double round = most / std::sqrt(std::max(square, 1e-300));
    const double share = std::clamp(2 * most - 1, 0.0, 1.0);  // the ball's radius is 0.5
    for (std::size_t i = 0; i < d; ++i) mesh.coordinates[at + i] *= share + (1 - share) * round;
  }
  const AdaptOptions options = options_on(mesh);
  for (int trial = 0; trial < 10; ++trial) {
    const double angle = test::uniform(random, 0, 6), level = test::uniform(random, -0.6, 0.6);
    std::vector<double> values(mesh.vertex_count());
    for (std::size_t v = 0; v < values.size(); ++v)
      values[v] = std::cos(angle) * mesh.coordinates[d * v] +
                  std::sin(angle) * mesh.coordinates[d * v + 1] - level;
    const CutMesh cut = meshadapt::cut(executor, mesh, values, {});
    const AdaptedMesh adapted = adapt(executor, cut.mesh, constant_metric(cut.mesh, 0.25), options);
    EXPECT_EQ(test::joined(check_adapted(executor, cut.mesh, adapted.mesh, tolerance)), "");
    AnyMesh smaller = cut.mesh;
    for (double& x : smaller.coordinates) x *= 0.97;
    EXPECT_THROW(adapt(executor, smaller, constant_metric(smaller, 0.25), options), InputError);
  }
}

TEST(Geometry, RefusesATolerance) {
  const AnyMesh mesh = ball(2, 8, true);
  for (const double wrong : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(Geometry(Executor({.threads = 1}), mesh, {.tolerance = wrong}), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::geometry_test
