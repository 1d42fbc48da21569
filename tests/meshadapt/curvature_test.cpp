#include "geometry/curvature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/default_metric.hpp"
#include "ductile/meshadapt/make_mesh.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::curvature_test {
namespace {

using runtime::Executor;

const Executor executor({.threads = 2});
constexpr double asked = 10;

/// Sizes are asked to be 10 everywhere; those that curved boundaries leave, within this tolerance.
template <int Dim>
std::vector<Metric<Dim>> bounded(const AnyMesh& any, double tolerance) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const auto mesh = make_mesh<Dim>(executor, any, {.surface_tolerance = 1}, neighbours, warnings);
  std::vector<Metric<Dim>> metric_of(any.vertex_count(), isotropic<Dim>(asked));
  bound_curved_sizes(executor, mesh, tolerance, metric_of);
  return metric_of;
}

template <int Dim>
double size_along(const Metric<Dim>& metric, const Vector<Dim>& direction) {
  return norm(direction) / std::sqrt(squared_length(metric, direction));
}

/// Calls visit(v, radius, along) for each vertex of an arc (see test::bend) that is on one of its
/// two curved sides and not at their ends, with the direction in which these bend.
template <int Dim>
void each_on_curved_sides(const AnyMesh& any, double angle, auto&& visit) {
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<Dim>(any, v);
    const double radius = std::hypot(p[0], p[1]), turn = std::atan2(p[1], p[0]);
    const bool curved = std::abs(radius - 0.5) < 1e-9 || std::abs(radius - 1.5) < 1e-9;
    Vector<Dim> along{};
    along[0] = -std::sin(turn);
    along[1] = std::cos(turn);
    if (curved && turn > 1e-9 && turn < angle - 1e-9) visit(v, radius, along);
  }
}

template <int Dim>
void takes_sizes_from_arcs(int n) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  test::bend(any, 2);
  const auto metric_of = bounded<Dim>(any, 0.01);
  std::size_t count = 0;
  each_on_curved_sides<Dim>(any, 2, [&](std::size_t v, double radius, const Vector<Dim>& along) {
    EXPECT_NEAR(size_along(metric_of[v], along) / std::sqrt(8 * 0.01 * radius), 1, 0.03);
    EXPECT_EQ(metric_of[v].m[1], 0) << "as much in all directions";
    ++count;
  });
  const auto left = std::count(metric_of.begin(), metric_of.end(), isotropic<Dim>(asked));
  EXPECT_EQ(static_cast<std::size_t>(left) + count, any.vertex_count()) << "all else is as it was";
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
  each_on_curved_sides<2>(any, 2, [&](std::size_t v, double radius, const Vector<2>& along) {
    EXPECT_NEAR(size_along(metric_of[v], along) / (radius * 2 / n), 1, 0.03);
  });
}

/// Between two spheres: 2 degrees of longitude and latitude a cell.
TEST(CurvedSizes, AreThoseOfASphere) {
  AnyMesh any = test::make_grid(test::unit_grid(3, 12));
  for (std::size_t at = 0; at < any.coordinates.size(); at += 3) {
    double* p = &any.coordinates[at];
    const double radius = 1 + p[0], u = 0.4 * (p[1] - 0.5), v = 0.4 * (p[2] - 0.5);
    p[0] = radius * std::cos(u) * std::cos(v);
    p[1] = radius * std::sin(u) * std::cos(v);
    p[2] = radius * std::sin(v);
  }
  const auto metric_of = bounded<3>(any, 0.02);
  std::size_t count = 0;
  for (std::size_t v = 0; v < any.vertex_count(); ++v) {
    const auto p = position_in<3>(any, v);
    const double radius = norm(p);
    const bool inside = std::abs(p[1]) < 0.15 * radius && std::abs(p[2]) < 0.15 * radius;
    if (!inside || std::abs(radius - 2) > 1e-9) continue;
    EXPECT_NEAR(size_along(metric_of[v], p) / std::sqrt(8 * 0.02 * radius), 1, 0.05);
    ++count;
  }
  EXPECT_GT(count, 20U);
}

/// A tube thicker than the edges that its outside must have: sizes that grow inwards make better
/// elements than those asked for.
TEST(CurvedSizes, MakeBetterShapesWithGradation) {
  AnyMesh any = test::make_grid(test::unit_grid(3, 10));
  test::bend(any, 2);
  AdaptOptions options;
  options.make.surface_tolerance = 2e-3;
  const AnyField metric = constant_metric(any, 0.5);
  const auto quality = [&] {
    const AdaptedMesh result = adapt(executor, any, metric, options);
    const AnyField same = constant_metric(result.mesh, 0.5);
    return measure(executor, result.mesh, &same).quality.mean;
  };
  const double as_asked = quality();
  options.gradation = 1.3;
  EXPECT_GT(quality(), as_asked + 0.05);
}

}  // namespace
}  // namespace ductile::meshadapt::curvature_test
