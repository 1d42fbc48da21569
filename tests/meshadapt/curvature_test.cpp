#include "geometry/curvature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "core/unit.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "geometry/curvature_fit.hpp"
#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::curvature_test {
namespace {

using runtime::Executor;

const Executor executor({.threads = 2});
constexpr double asked = 10;

/// Asks for sizes of 10 everywhere and returns the metric bounded by curvature, within this
/// tolerance.
template <int Dim>
std::vector<Metric<Dim>> bounded(const AnyMesh& any, double tolerance) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const auto mesh = make_mesh<Dim>(executor, any, {.hausdorff_tolerance = 1}, neighbours, warnings);
  std::vector<Metric<Dim>> metric_of(any.vertex_count(), isotropic<Dim>(asked));
  bound_curved_sizes(executor, mesh, tolerance, metric_of);
  return metric_of;
}

template <int Dim>
double size_along(const Metric<Dim>& metric, const Vector<Dim>& direction) {
  return norm(direction) / std::sqrt(squared_length(metric, direction));
}

/// Calls visit(v, radius, along) for each vertex on the two curved sides of an arc (see
/// test::bend), with the direction along which these bend.
template <int Dim>
void each_on_curved_sides(const AnyMesh& any, auto&& visit) {
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<Dim>(any, v);
    const double radius = std::hypot(p[0], p[1]), turn = std::atan2(p[1], p[0]);
    const bool curved = std::abs(radius - 0.5) < 1e-9 || std::abs(radius - 1.5) < 1e-9;
    Vector<Dim> along{};
    along[0] = -std::sin(turn);
    along[1] = std::cos(turn);
    if (curved) visit(v, radius, along);
  }
}

template <int Dim>
void takes_sizes_from_arcs(int n) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  test::bend(any, 2);
  const auto metric_of = bounded<Dim>(any, 0.01);
  std::size_t count = 0;
  each_on_curved_sides<Dim>(any, [&](std::size_t v, double radius, const Vector<Dim>& along) {
    Vector<Dim> outwards{}, axis{};
    outwards[0] = along[1];
    outwards[1] = -along[0];
    axis[Dim - 1] = 1;
    EXPECT_NEAR(size_along(metric_of[v], along) / std::sqrt(8 * 0.01 * radius), 1, 0.03);
    EXPECT_NEAR(size_along(metric_of[v], outwards) / std::sqrt(8 * 0.01 * radius), 1, 0.03);
    if (Dim == 3) {
      EXPECT_GT(size_along(metric_of[v], axis), 0.6 * asked);
    }
    ++count;
  });
  const auto left = std::count(metric_of.begin(), metric_of.end(), isotropic<Dim>(asked));
  EXPECT_EQ(static_cast<std::size_t>(left) + count, any.vertex_count())
      << "sizes elsewhere have changed";
  EXPECT_GT(count, 20U);
}

TEST(CurvedSizes, AreThoseOfChordsThatStayClose) {
  takes_sizes_from_arcs<2>(40);
  takes_sizes_from_arcs<3>(16);
}

TEST(CurvedSizes, AreNotSmallerThanTheEdgesThere) {
  constexpr int n = 40;
  AnyMesh any = test::make_grid(test::unit_grid(2, n));
  test::bend(any, 2);
  const auto metric_of = bounded<2>(any, 1e-9);
  each_on_curved_sides<2>(any, [&](std::size_t v, double radius, const Vector<2>& along) {
    EXPECT_NEAR(size_along(metric_of[v], along) / (radius * 2 / n), 1, 0.03);
  });
}

/// A grid of n^3 cells, with its vertices mapped by `map`.
AnyMesh mapped(int n, auto&& map) {
  AnyMesh any = test::make_grid(test::unit_grid(3, n));
  for (std::size_t at = 0; at < any.coordinates.size(); at += 3) {
    const Vector<3> to = map(any.coordinates[at], any.coordinates[at + 1], any.coordinates[at + 2]);
    std::copy(to.x.begin(), to.x.end(), &any.coordinates[at]);
  }
  return any;
}

/// The domain lies between two spheres; a cell covers 2 degrees of longitude and latitude.
TEST(CurvedSizes, AreThoseOfASphere) {
  const AnyMesh any = mapped(12, [](double x, double y, double z) {
    const double radius = 1 + x, u = 0.4 * (y - 0.5), v = 0.4 * (z - 0.5);
    return radius * Vector<3>{{std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)}};
  });
  const auto metric_of = bounded<3>(any, 0.02);
  std::size_t count = 0;
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<3>(any, v);
    const double radius = norm(p);
    const bool inside = std::abs(p[1]) < 0.15 * radius && std::abs(p[2]) < 0.15 * radius;
    if (!inside || std::abs(radius - 2) > 1e-9) continue;
    for (const Vector<3>& direction : {p, Vector<3>{{-p[1], p[0], 0}}, Vector<3>{{0, 0, 1}}})
      EXPECT_NEAR(size_along(metric_of[v], direction) / std::sqrt(8 * 0.02 * radius), 1, 0.05);
    ++count;
  }
  EXPECT_GT(count, 20U);
}

/// The metric in the middle of the side that is z = 1 in the cube.
Metric<3> metric_on_top(const AnyMesh& any, double tolerance) {
  const auto metric_of = bounded<3>(any, tolerance);
  std::size_t middle = 0;
  double least = 1e9;
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<3>(any, v);
    const double off = std::hypot(p[0], p[1]) - 0.1 * p[2];
    if (off < least) least = off, middle = v;
  }
  return metric_of[middle];
}

/// The curvatures are 0.8 and -0.2; sizes are bounded whatever the sign.
TEST(CurvedSizes, AreThoseOfASaddle) {
  const AnyMesh any = mapped(16, [](double x, double y, double z) {
    const double u = x - 0.5, v = y - 0.5;
    return Vector<3>{{u, v, z + z * (0.4 * u * u - 0.1 * v * v)}};
  });
  const Metric<3> metric = metric_on_top(any, 0.004);
  EXPECT_NEAR(size_along(metric, {{1, 0, 0}}) / std::sqrt(8 * 0.004 / 0.8), 1, 0.05);
  EXPECT_NEAR(size_along(metric, {{0, 1, 0}}) / std::sqrt(8 * 0.004 / 0.2), 1, 0.05);
  EXPECT_NEAR(size_along(metric, {{0, 0, 1}}) / std::sqrt(8 * 0.004 / 0.8), 1, 0.05);
}

/// The top is the outside of a torus with radii 1 and 0.4, along x and y.
TEST(CurvedSizes, AreThoseOfATorus) {
  const AnyMesh any = mapped(16, [](double x, double y, double z) {
    const double u = x - 0.5, v = y - 0.5, r = 0.2 + 0.2 * z, from_axis = 1 + r * std::cos(u);
    return Vector<3>{{r * std::sin(u), from_axis * std::sin(v), from_axis * std::cos(v)}};
  });
  const Metric<3> metric = metric_on_top(any, 0.002);
  EXPECT_NEAR(size_along(metric, {{1, 0, 0}}) / std::sqrt(8 * 0.002 * 0.4), 1, 0.05);
  EXPECT_NEAR(size_along(metric, {{0, 1, 0}}) / std::sqrt(8 * 0.002 * 1.4), 1, 0.05);
}

/// A circle on a flat lid separates two references: only the curve bends there.
TEST(CurvedSizes, AreThoseOfACurve) {
  AnyMesh any = test::truncated_cone(12, 1);
  const auto is_inside = [&](const auto& corners) {
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
      const auto p = position_in<3>(any, v);
      return p[2] > 1 - 1e-9 && std::hypot(p[0], p[1]) < 0.51;
    });
  };
  for (std::size_t t = 0; t < any.triangles.size(); ++t)
    if (is_inside(any.triangles.vertices[t])) any.triangles.reference[t] = 9;
  const auto metric_of = bounded<3>(any, 0.01);
  std::size_t count = 0;
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<3>(any, v);
    const double radius = std::hypot(p[0], p[1]);
    if (p[2] < 1 - 1e-9 || std::abs(radius - 0.5) > 1e-6) continue;
    // The limit is generous, because the input has only 24 edges around the circle.
    EXPECT_LT(size_along(metric_of[v], {{-p[1], p[0], 0}}), 0.3);
    EXPECT_GT(size_along(metric_of[v], {{0, 0, 1}}), 0.9 * asked);
    ++count;
  }
  EXPECT_GT(count, 12U);
}

/// The mesh is coarser than the chords that the tolerance allows; the geometry knows better.
template <int Dim>
void takes_sizes_from_the_geometry(int fine, double turn) {
  AnyMesh from = test::make_grid(test::unit_grid(Dim, fine));
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 7));
  test::bend(from, turn);
  test::bend(any, turn);
  const double tolerance = 0.01 * turn * turn / 4;
  AdaptOptions options;
  options.make.hausdorff_tolerance = tolerance;
  options.make.geometry =
      std::make_shared<const Geometry>(executor, from, GeometryOptions{.tolerance = tolerance});
  const auto bounded =
      bound_at_curved_boundaries(executor, any, constant_metric(any, asked), options);
  std::size_t count = 0;
  each_on_curved_sides<Dim>(any, [&](std::size_t v, double radius, const Vector<Dim>& along) {
    Metric<Dim> metric;
    std::copy_n(&bounded.values[v * metric.m.size()], metric.m.size(), metric.m.begin());
    EXPECT_NEAR(size_along(metric, along) / std::sqrt(8 * tolerance * radius), 1, 0.05);
    ++count;
  });
  EXPECT_GT(count, 12U);
}

TEST(CurvedSizes, AreThoseOfTheGeometryOnACoarseMesh) {
  for (const double turn : {1.0, 1.5, 2.0}) {
    SCOPED_TRACE(turn);
    takes_sizes_from_the_geometry<2>(40, turn);
    takes_sizes_from_the_geometry<3>(20, turn);
  }
}

// ---- The fit ----

using test::Random;

Vector<3> random_direction(Random& random) {
  Vector<3> v;
  do
    for (double& x : v.x) x = test::uniform(random, -1, 1);
  while (norm(v) > 1 || norm(v) < 0.1);
  return unit(v);
}

/// The largest curvatures of fits to points at random up to 60 degrees away, to one side mostly,
/// with directions to either side: of a sphere, or a cylinder along `axis`.
TEST(CurvatureFit, IsExactOnSpheresAndCylinders) {
  for (auto seed = test::first_trial(); seed < test::end_of_trials(200); ++seed) {
    Random random(seed);
    const bool is_sphere = test::chance(random, 0.5);
    const double radius = std::pow(10.0, test::uniform(random, -2, 2));
    const Vector<3> axis = random_direction(random);
    const Vector<3> normal = unit(cross(axis, random_direction(random)));
    const Vector<3> around = cross(axis, normal);
    CurvatureFit<3, 3> fit(normal);
    for (int i = 0; i < 12; ++i) {
      const double u = test::uniform(random, -0.2, 1), v = test::uniform(random, -0.2, 1);
      const Vector<3> there = is_sphere ? unit(normal + u * axis + v * around)
                                        : std::cos(v) * normal + std::sin(v) * around;
      const Vector<3> along = (is_sphere ? 0 : u * radius) * axis;
      const double side = test::chance(random, 0.5) ? 1 : -1;
      fit.add(radius * (there - normal) + along, side * there, test::uniform(random, 0.1, 1));
    }
    SCOPED_TRACE(seed);
    const auto found = fit.curvature();
    EXPECT_EQ(found.value[0], 0);
    const std::size_t most = found.value[1] > found.value[2] ? 1 : 2;
    EXPECT_NEAR(found.value[most] * radius, 1, 1e-6);
    EXPECT_NEAR(found.value[3 - most] * radius, is_sphere ? 1 : 0, 1e-6);
    if (!is_sphere) {
      EXPECT_NEAR(std::abs(dot(found.vector[most], around)), 1, 1e-6);
    }
  }
}

TEST(CurvatureFit, IsExactOnCirclesInThePlaneAndInSpace) {
  for (auto seed = test::first_trial(); seed < test::end_of_trials(200); ++seed) {
    Random random(seed);
    const double radius = std::pow(10.0, test::uniform(random, -2, 2));
    const Vector<3> out = random_direction(random);
    const Vector<3> along = unit(cross(out, random_direction(random)));
    const double turned = test::uniform(random, 0, 6);
    const Vector<2> out_2d{{std::cos(turned), std::sin(turned)}}, along_2d{{-out_2d[1], out_2d[0]}};
    CurvatureFit<3, 2> fit(along);
    CurvatureFit<2, 2> fit_2d(along_2d);
    for (int i = 0; i < 6; ++i) {
      const double angle = test::uniform(random, -0.2, 1), weight = test::uniform(random, 0.1, 1);
      const double s = std::sin(angle), c = std::cos(angle);
      const double side = test::chance(random, 0.5) ? 1 : -1;
      fit.add(radius * ((c - 1) * out + s * along), side * (c * along - s * out), weight);
      fit_2d.add(radius * ((c - 1) * out_2d + s * along_2d), side * (c * along_2d - s * out_2d),
                 weight);
    }
    SCOPED_TRACE(seed);
    EXPECT_NEAR(fit.curvature().value[1] * radius, 1, 1e-6);
    EXPECT_NEAR(fit_2d.curvature().value[1] * radius, 1, 1e-6);
    EXPECT_NEAR(std::abs(dot(fit.curvature().vector[0], out)), 1, 1e-6);
    EXPECT_EQ(fit.curvature().value[2], 0);
    EXPECT_LT(norm(fit.rise()(radius * ((std::cos(0.5) - 1) * out + std::sin(0.5) * along)) -
                   fit.rise()({})),
              0.05 * radius);
  }
}

// ---- Sizes from curvature alone ----

/// Mean lengths of edges on the mantle of a cylinder, along the z axis and around it.
struct MantleEdges {
  double along = 0, around = 0;  // means
  std::size_t facets = 0;
};
MantleEdges mantle_edges(const AnyMesh& any) {
  MantleEdges found;
  std::size_t along = 0, around = 0;
  for (std::size_t t = 0; t < any.triangles.size(); ++t) {
    if (any.triangles.reference[t] != 1) continue;
    ++found.facets;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& corners = any.triangles.vertices[t];
      const Vector<3> edge =
          position_in<3>(any, corners[i]) - position_in<3>(any, corners[(i + 1) % 3]);
      const double flat = std::hypot(edge[0], edge[1]), high = std::abs(edge[2]);
      if (high > 2 * flat) found.along += high, ++along;
      if (flat > 2 * high) found.around += flat, ++around;
    }
  }
  found.along /= static_cast<double>(along);
  found.around /= static_cast<double>(around);
  return found;
}

/// Around the cylinder chords are 0.28, along it edges are as long as asked for: a few of about 1.
/// Equal sizes of 0.28 would make 2 pi / (0.28^2 sqrt(3) / 4) = 185 facets or more.
TEST(CurvedSizes, AloneMakeACylinderOfLongElements) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  const AnyMesh any = test::truncated_cone(16, 1);
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.01;
  options.curved_sizes = true;
  const AdaptedMesh result = adapt(executor, any, coarsest_metric(any), options);
  const MantleEdges edges = mantle_edges(result.mesh);
  EXPECT_GT(edges.along, 0.45);
  EXPECT_GT(edges.around, 0.18);
  EXPECT_LT(edges.around, 0.32);
  EXPECT_LT(edges.facets, 130U);
  for (const int threads : {1, 3, 4, 8}) {
    const AdaptedMesh other =
        adapt(Executor({.threads = threads}), any, coarsest_metric(any), options);
    EXPECT_EQ(other.mesh.coordinates, result.mesh.coordinates) << threads;
    EXPECT_EQ(other.mesh.tetrahedra.vertices, result.mesh.tetrahedra.vertices) << threads;
  }
}

TEST(CurvedSizes, AloneLeaveABoxAsCoarseAsMayBe) {
  const AnyMesh any = test::make_grid(test::unit_grid(3, 6));
  AdaptOptions options;
  options.make.hausdorff_tolerance = 0.01;
  options.curved_sizes = true;
  const AdaptedMesh result = adapt(executor, any, coarsest_metric(any), options);
  EXPECT_LT(result.mesh.tetrahedra.size(), 30U);
  options.make.hausdorff_tolerance = 0;
  EXPECT_THROW(adapt(executor, any, coarsest_metric(any), options), InputError);
}

/// The tube is thicker than the edges on its outside: if sizes grow inwards, elements are better
/// than in the requested sizes.
TEST(CurvedSizes, MakeBetterShapesWithGradation) {
  AnyMesh any = test::make_grid(test::unit_grid(3, 10));
  test::bend(any, 2);
  AdaptOptions options;
  options.make.hausdorff_tolerance = 2e-3;
  const AnyField metric = constant_metric(any, 0.5);
  const auto quality = [&] {
    const AdaptedMesh result = adapt(executor, any, metric, options);
    return measure(executor, result.mesh, &result.metric).quality.mean;
  };
  const double as_asked = quality();
  options.gradation = 1.3;
  EXPECT_GT(quality(), as_asked + 0.05);
}

}  // namespace
}  // namespace ductile::meshadapt::curvature_test
