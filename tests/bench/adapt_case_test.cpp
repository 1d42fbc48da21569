#include "cases/adapt_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cases/formulas.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"

namespace ductile::bench {
namespace {

using meshadapt::AnyField;
using meshadapt::Metric;
using runtime::Executor;

/// Small enough for a quick test.
std::string small(const CaseInfo& info) {
  return info.complexity < 20000 ? std::string(info.name) : std::string(info.name) + "@0.02";
}

template <int Dim>
double least_eigenvalue(const Executor& executor, const AnyField& field) {
  double least = INFINITY;
  for (const Metric<Dim>& metric : meshadapt::tensors_of<Dim>(executor, field))
    for (const double value : meshadapt::principal_axes(metric).value)
      least = std::min(least, value);
  return least;
}

TEST(AdaptCase, StartsFromAValidMeshWithAPositiveDefiniteMetric) {
  const Executor executor({.threads = 2});
  for (const CaseInfo& info : known_cases()) {
    SCOPED_TRACE(info.name);
    const AdaptCase made = make_case(executor, small(info));
    EXPECT_EQ(made.dimension, info.dimension);
    EXPECT_TRUE(is_sound(executor, made, made.start));
    const AnyField metric = made.metric_on(executor, made.start);
    EXPECT_EQ(metric.vertex_count, made.start.vertex_count());
    EXPECT_GT(info.dimension == 2 ? least_eigenvalue<2>(executor, metric)
                                  : least_eigenvalue<3>(executor, metric),
              0);
  }
}

/// A fine mesh, finer still towards y = 0.
meshadapt::AnyMesh fine_mesh(const Executor& executor, int dimension) {
  meshadapt::AnyMesh mesh = make_case(executor, dimension == 2 ? "uni2d@20" : "uni3d@20").start;
  if (dimension == 2)
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      double& y = mesh.coordinates[2 * v + 1];
      y = std::pow(y, 3);
    }
  return mesh;
}

TEST(AdaptCase, HasTheComplexityThatItTells) {
  const Executor executor({.threads = 2});
  const std::array fine{fine_mesh(executor, 2), fine_mesh(executor, 3)};
  for (const CaseInfo& info : known_cases()) {
    SCOPED_TRACE(info.name);
    const AdaptCase made = make_case(executor, small(info));
    const auto& mesh = made.hausdorff_tolerance > 0
                           ? made.start
                           : fine[static_cast<std::size_t>(info.dimension) - 2];
    const AnyField metric = made.metric_on(executor, mesh);
    const double complexity = measure(executor, mesh, &metric).complexity;
    EXPECT_NEAR(complexity / made.complexity, 1, info.dimension == 2 ? 0.06 : 0.15);
  }
}

TEST(AdaptCase, HasTheElementCountsOfTheTable) {
  const Executor executor({.threads = 2});
  EXPECT_EQ(element_count(make_case(executor, "psi2d").start), 20000U);
  EXPECT_EQ(element_count(make_case(executor, "uni2d").start), 2048U);
  EXPECT_EQ(element_count(make_case(executor, "uni3d").start), 6000U);
  EXPECT_EQ(element_count(make_case(executor, "cube-linear").start), 162U);
}

/// Adapting to the formula again and again gives about the number of elements that its complexity
/// predicts.
TEST(AdaptCase, LeadsToAsManyElementsAsItsComplexityPromises) {
  const Executor executor({.threads = 2});
  AdaptCase made = make_case(executor, "psi2d@0.01");
  meshadapt::AnyMesh mesh = made.start;
  for (int call = 0; call < 3; ++call)
    mesh = adapt(executor, mesh, made.metric_on(executor, mesh)).mesh;
  EXPECT_NEAR(static_cast<double>(element_count(mesh)) / (2.31 * made.complexity), 1, 0.1);
}

TEST(AdaptCase, GrowsWithTheFactor) {
  const Executor executor({.threads = 2});
  for (const char* name : {"psi2d@0.04", "psi3d@0.01", "uni2d", "uni3d", "ring2d", "dome3d"}) {
    SCOPED_TRACE(name);
    const AdaptCase one = make_case(executor, name), four = make_case(executor, times(name, 4));
    EXPECT_NEAR(four.complexity / one.complexity, 4, 1e-12);
    const double growth = static_cast<double>(element_count(four.start)) /
                          static_cast<double>(element_count(one.start));
    EXPECT_NEAR(growth, 4, 0.8);
  }
}

TEST(AdaptCase, LayerMeshIsAHundredTimesCoarser) {
  const Executor executor({.threads = 2});
  const AdaptCase made = make_case(executor, "layer3d@0.2");
  const AnyField metric = made.metric_on(executor, made.start);
  // 11 tetrahedra per unit of complexity, and more in a mesh this small, half of it boundary.
  const double promised = 11 * made.complexity / 100;
  EXPECT_NEAR(static_cast<double>(element_count(made.start)) / promised, 1.3, 0.4);
  EXPECT_NEAR(measure(executor, made.start, &metric).complexity / made.complexity, 1, 0.2);
}

TEST(AdaptCase, DoesNotDependOnTheExecutor) {
  const AdaptCase one = make_case(Executor({.threads = 1}), "layer3d@0.02");
  const AdaptCase other =
      make_case(Executor({.threads = 3, .deterministic = false}), "layer3d@0.02");
  EXPECT_EQ(one.start.coordinates, other.start.coordinates);
  EXPECT_EQ(one.start.tetrahedra.vertices, other.start.tetrahedra.vertices);
}

TEST(AdaptCase, RefusesUnknownNamesAndFactors) {
  const Executor executor({.threads = 1});
  for (const char* name : {"psi4d", "psi2d@", "psi2d@0", "psi2d@-1", "psi2d@2x", "psi2d@inf", ""})
    EXPECT_THROW(make_case(executor, name), meshadapt::InputError) << name;
}

TEST(AdaptCase, IsNotSoundOnceTheDomainIsLeft) {
  const Executor executor({.threads = 2});
  for (const char* name : {"uni2d@0.01", "uni3d@0.01", "ring2d@0.01", "dome3d@0.01"}) {
    SCOPED_TRACE(name);
    const AdaptCase made = make_case(executor, name);
    EXPECT_TRUE(is_sound(executor, made, made.start));
    meshadapt::AnyMesh moved = made.start;
    for (double& x : moved.coordinates) x *= made.hausdorff_tolerance == 0 ? 1 + 1e-6 : 2;
    EXPECT_FALSE(is_sound(executor, made, moved));
    moved = made.start;
    (made.dimension == 2 ? moved.edges.vertices.back()[0] : moved.triangles.vertices.back()[0]) = 0;
    EXPECT_FALSE(is_sound(executor, made, moved));
  }
}

// ---- Values computed by hand ----

TEST(Formulas, LayersHaveThePublishedSizes) {
  const Metric<2> on_circle = circle_metric({{0.75, 0.5}});
  EXPECT_NEAR(on_circle(0, 0), 1e6, 1e-3);
  EXPECT_NEAR(on_circle(1, 1), 100, 1e-9);
  EXPECT_NEAR(circle_metric({{0.5, 0.5}})(0, 0), 100, 1e-9);
  EXPECT_NEAR(boundary_metric({{0.3, 0}})(1, 1), 1e10, 1);
  EXPECT_NEAR(boundary_metric({{0.3, 0.5}})(1, 1), 1e4, 1e-6);
  EXPECT_NEAR(cube_linear_metric({{0, 0, 0.5}})(2, 2), 1e6, 1e-3);
  EXPECT_NEAR(cube_linear_metric({{0, 0, 1}})(2, 2), 100, 1e-9);
}

/// Steps as long as the sizes, along the short axis and across it, have metric length 1.
TEST(Formulas, TurningMetricsTurn) {
  const Metric<2> flat = turning_metric(meshadapt::Vector<2>{{0.4, 0.2}});
  const double turn = 1.5 * 0.4 + 0.5 * 0.2, c = std::cos(turn), s = std::sin(turn);
  EXPECT_NEAR(squared_length(flat, {{0.004 * c, 0.004 * s}}), 1, 1e-9);
  EXPECT_NEAR(squared_length(flat, {{-0.1 * s, 0.1 * c}}), 1, 1e-9);
  const auto axes = principal_axes(turning_metric(meshadapt::Vector<3>{{0.3, 0.1, 0.9}}));
  std::array<double, 3> sizes;
  std::transform(axes.value.begin(), axes.value.end(), sizes.begin(),
                 [](double value) { return 1 / std::sqrt(value); });
  std::sort(sizes.begin(), sizes.end());
  EXPECT_NEAR(sizes[0], 0.01, 1e-9);
  EXPECT_NEAR(sizes[1], 0.25, 1e-9);
  EXPECT_NEAR(sizes[2], 0.25, 1e-9);
}

TEST(Formulas, CurvedLayerIsAHundredTimesThinnerThanWide) {
  const auto formula = curved_layer_metric(Executor({.threads = 1}), 1000);
  const auto on_layer = meshadapt::principal_axes(formula({{0.5, 0.25, 0.5}})).value;
  const auto [least, most] = std::minmax_element(on_layer.begin(), on_layer.end());
  EXPECT_NEAR(std::sqrt(*most / *least), 100, 1e-6);
  const auto far_off = meshadapt::principal_axes(formula({{0.5, 0.25, 1}})).value;
  EXPECT_NEAR(far_off[0] / far_off[2], 1, 1e-9);
}

}  // namespace
}  // namespace ductile::bench
