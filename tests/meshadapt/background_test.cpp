#include "operators/background.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ductile/runtime/parallel_for.hpp"
#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::background_test {
namespace {

using runtime::Executor;
using test::difference;
using test::Random;
using test::uniform;

template <class Dimension>
class BackgroundIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(BackgroundIn, Dimensions);

/// A mesh with a hole, so that straight walks may end at a boundary.
template <int Dim>
struct Scene {
  AnyMesh any;
  Mesh<Dim> mesh;
  std::vector<Metric<Dim>> metric_of;
  std::unique_ptr<Background<Dim>> background;

  explicit Scene(Random& random) {
    test::Grid grid = test::unit_grid(Dim, 6);
    grid.region = test::with_hole(6);
    any = test::make_grid(grid);
    test::jiggle(any, random, 0.3);
    const Executor executor({.threads = 2});
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
    for (std::size_t v = 0; v < any.vertex_count(); ++v) {
      std::array<double, Dim> sizes;
      for (double& h : sizes) h = std::pow(10.0, uniform(random, -1.3, 0));
      metric_of.push_back(test::random_metric<Dim>(random, sizes));
    }
    for (std::size_t v = 0; v < metric_of.size(); ++v) mesh.site_of[v].metric = metric_of[v];
    background = std::make_unique<Background<Dim>>(executor, mesh, std::move(neighbours));
  }
};

/// Chooses a point in a random element, and computes the metric there by the definition.
template <int Dim>
Metric<Dim> brute_force(const Scene<Dim>& scene, Random& random, Vector<Dim>& point) {
  const auto& corners = scene.mesh.corners_of[test::below(random, scene.mesh.element_slots())];
  std::array<double, Dim + 1> weight;
  double sum = 0;
  for (double& w : weight) sum += w = uniform(random, 0, 1);
  point = {};
  Metric<Dim> log_metric;
  for (std::size_t i = 0; i <= Dim; ++i) {
    point += (weight[i] / sum) * scene.mesh.site_of[corners[i]].position;
    log_metric += (weight[i] / sum) * logarithm(scene.metric_of[corners[i]]);
  }
  return exponential(log_metric);
}

TYPED_TEST(BackgroundIn, FindsEveryPointFromEverywhere) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  const Scene<Dim> scene(random);
  for (int trial = 0; trial < 2000; ++trial) {
    Vector<Dim> point;
    const Metric<Dim> expected = brute_force(scene, random, point);
    const auto near = static_cast<ElementId>(test::below(random, scene.mesh.element_slots()));
    const auto sample = scene.background->sample(point, near);
    ASSERT_LT(difference(expected, sample.metric), 1e-8) << "trial " << trial;
  }
}

TYPED_TEST(BackgroundIn, GivesTheMetricOfAVertexThere) {
  constexpr int Dim = TypeParam::value;
  Random random(4);
  const Scene<Dim> scene(random);
  for (VertexId v = 0; v < scene.mesh.vertex_slots(); v += 3) {
    const auto sample = scene.background->sample(scene.mesh.site_of[v].position, 0);
    EXPECT_LT(difference(scene.metric_of[v], sample.metric), 1e-8);
    EXPECT_TRUE(contains(scene.mesh.corners_of[sample.host], v));
  }
}

/// The barycentric weights of such an element are not finite.
TYPED_TEST(BackgroundIn, GivesAMetricWhereAnElementIsFlatByRounding) {
  constexpr int Dim = TypeParam::value;
  Random random(11);
  Scene<Dim> scene(random);
  const Executor executor({.threads = 1});
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, scene.any, {}, neighbours, warnings);
  for (std::size_t v = 0; v < scene.metric_of.size(); ++v) mesh.site_of[v] = scene.mesh.site_of[v];
  const ElementId flat = 17;
  const Corners<Dim> corners = mesh.corners_of[flat];
  mesh.site_of[corners[Dim]].position = mesh.site_of[corners[0]].position;
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  for (int i = 0; i < 100; ++i) {
    Vector<Dim> point;
    for (double& x : point.x) x = uniform(random, 0, 1);
    for (const double component : background.sample(point, flat).metric.m)
      EXPECT_TRUE(std::isfinite(component)) << i;
  }
}

TYPED_TEST(BackgroundIn, TakesAPointOutsideToBeInTheClosestElement) {
  constexpr int Dim = TypeParam::value;
  Random random(5);
  const Scene<Dim> scene(random);
  for (const double beyond : {1e-15, 1e-9, 1e-3, 10.0}) {
    Vector<Dim> outside;
    outside.x.fill(0.3);
    outside[0] = 1 + beyond;
    const auto sample = scene.background->sample(outside, 0);
    for (int i = 0; i < Dim; ++i) {
      EXPECT_TRUE(std::isfinite(sample.metric(i, i)));
      EXPECT_GT(sample.metric(i, i), 0);
    }
  }
}

/// Points of a facet of the outer boundary, moved straight out of the unit box, have their old
/// positions as closest points.
TYPED_TEST(BackgroundIn, GivesAPointOutsideTheMetricOfTheClosestPoint) {
  constexpr int Dim = TypeParam::value;
  Random random(6);
  const Scene<Dim> scene(random);
  constexpr std::size_t points = 3000;
  std::vector<Vector<Dim>> on(points), beyond(points);
  std::vector<ElementId> near(points);
  for (std::size_t i = 0; i < points; ++i) {
    for (int axis = 0; axis < Dim; ++axis) on[i][axis] = uniform(random, 0, 1);
    const int axis = static_cast<int>(i) % Dim;
    on[i][axis] = i % 2 == 0 ? 0 : 1;
    beyond[i] = on[i];
    beyond[i][axis] += (i % 2 == 0 ? -1 : 1) * std::pow(10.0, uniform(random, -3, 1));
    near[i] = static_cast<ElementId>(test::below(random, scene.mesh.element_slots()));
  }
  const std::size_t before = scene.background->bytes();
  std::vector<double> difference_of(points);
  runtime::parallel_for(Executor({.threads = 4}), points, [&](std::size_t i) {
    const auto at = scene.background->sample(on[i], near[i]);
    const auto outside = scene.background->sample(beyond[i], near[i]);
    difference_of[i] = difference(at.metric, outside.metric);
  });
  EXPECT_LT(*std::max_element(difference_of.begin(), difference_of.end()), 1e-6);
  EXPECT_GT(scene.background->bytes(), before);
}

/// The size jumps from a small one in the middle of the box to 0.03 one element (1/6) away. It
/// grows linearly between the vertices, and the background estimates the number of elements
/// accordingly.
TYPED_TEST(BackgroundIn, LetsSizesGrowLinearlyWhereTheyJump) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (const double thin : {1e-4, 1e-5, 1e-7}) {
    const AnyMesh any = test::make_grid(test::unit_grid(Dim, 6));
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
    const auto size_at = [&](double distance) {
      return std::min(0.03, thin + (0.03 - thin) * 6 * distance);
    };
    const auto at_distance = [&](double distance) {
      PrincipalAxes<Dim> axes = principal_axes(isotropic<Dim>(0.05));
      for (std::size_t i = 0; i < Dim; ++i) axes.vector[i] = {}, axes.vector[i].x[i] = 1;
      axes.value[0] = 1 / (size_at(distance) * size_at(distance));
      return compose(axes);
    };
    for (std::size_t v = 0; v < mesh.vertex_slots(); ++v)
      mesh.site_of[v].metric = at_distance(std::abs(mesh.site_of[v].position[0] - 0.5));
    const Background<Dim> background(executor, mesh, std::move(neighbours));
    Random random(12);
    for (int trial = 0; trial < 200; ++trial) {
      Vector<Dim> point;
      for (double& x : point.x) x = uniform(random, 0, 1);
      const double distance = std::abs(point[0] - 0.5);
      const auto sample = background.sample(point, 0);
      EXPECT_LT(difference(at_distance(distance), sample.metric), 1e-6) << thin << ' ' << distance;
    }
    // Layers across: the integral of 1/size. The other sizes are 0.05.
    const double layers =
        2 * (std::log(0.03 / thin) / (6 * (0.03 - thin)) + (0.5 - 1.0 / 6) / 0.03);
    EXPECT_NEAR(background.complexity(executor) / (layers * std::pow(20, Dim - 1)), 1, 1e-3)
        << thin;
  }
}

}  // namespace
}  // namespace ductile::meshadapt::background_test
