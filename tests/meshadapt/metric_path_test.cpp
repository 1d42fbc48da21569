#include "adapt/metric_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::metric_path_test {
namespace {

using runtime::Executor;
using test::Random;

template <class Dimension>
class MetricPathIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MetricPathIn, Dimensions);

/// A jiggled grid and a metric whose sizes along the first axis are smaller by a factor.
template <int Dim>
struct Scene {
  Executor executor;
  Mesh<Dim> mesh;
  std::unique_ptr<Background<Dim>> background;

  Scene(int threads, double stretch, double size = 0.2) : executor({.threads = threads}) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, 5));
    Random random(7);
    test::jiggle(any, random, 0.2);
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
    Metric<Dim> metric;
    for (std::size_t i = 0, k = 0; i < Dim; k += ++i + 1) metric.m[k] = 1 / (size * size);
    metric.m[0] *= stretch * stretch;
    for (auto& site : mesh.site_of) site = make_site(site.position, metric);
    background = std::make_unique<Background<Dim>>(executor, mesh, std::move(neighbours));
  }
  MetricPath<Dim> path(bool by_demand = false) {
    return MetricPath<Dim>(executor, mesh, *background, by_demand);
  }
  std::vector<Metric<Dim>> log_metrics() {
    std::vector<Metric<Dim>> all;
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) all.push_back(background->log_metric(v));
    return all;
  }
};

/// Mean logarithm of the ratio of the second size to the first.
template <int Dim>
double log_stretch(const std::vector<Metric<Dim>>& log_metrics) {
  double sum = 0;
  for (const auto& m : log_metrics) sum += (m(0, 0) - m(1, 1)) / 2;
  return sum / static_cast<double>(log_metrics.size());
}

TYPED_TEST(MetricPathIn, HasAStepForEachThreefoldStretch) {
  constexpr int Dim = TypeParam::value;
  EXPECT_LE(Scene<Dim>(1, 1).path().steps(), 2);
  int before = 1;
  for (const double stretch : {9.0, 81.0, 729.0}) {
    for (const bool by_demand : {false, true}) {
      const int steps = Scene<Dim>(1, stretch).path(by_demand).steps();
      const double expected = std::log(stretch) / std::log(3.0);
      EXPECT_GE(steps, before);
      EXPECT_NEAR(steps, expected + 0.5, 1.6) << stretch;
    }
    before = Scene<Dim>(1, stretch).path().steps();
  }
  EXPECT_EQ(Scene<Dim>(1, 1e12).path().steps(), 20);
}

TYPED_TEST(MetricPathIn, EndsAtTheMetricThatWasThere) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene(2, 100);
  const auto wanted = scene.log_metrics();
  auto path = scene.path();
  path.go_to(0);
  EXPECT_NE(scene.log_metrics(), wanted);
  path.go_to(path.steps());
  EXPECT_EQ(scene.log_metrics(), wanted);
}

/// The path starts at a metric in which the mesh is about isotropic, and has equal steps.
TYPED_TEST(MetricPathIn, StretchesByTheSameInEachStep) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> scene(2, 200);
  auto path = scene.path();
  path.go_to(0);
  const double first = log_stretch(scene.log_metrics());
  const double step = (std::log(200.0) - first) / path.steps();
  for (int i = 0; i <= path.steps(); ++i) {
    path.go_to(i);
    EXPECT_NEAR(log_stretch(scene.log_metrics()), first + i * step, 1e-9) << i;
  }
}

/// Compares the number of elements that each step asks for.
TYPED_TEST(MetricPathIn, AsksForLittleMoreThanEitherEnd) {
  constexpr int Dim = TypeParam::value;
  for (const double size : {0.02, 0.2, 2.0}) {
    Scene<Dim> scene(2, 300, size);
    const double last = scene.background->complexity(scene.executor);
    auto path = scene.path();
    path.go_to(0);
    const double first = scene.background->complexity(scene.executor);
    for (int i = 1; i < path.steps(); ++i) {
      path.go_to(i);
      EXPECT_LT(scene.background->complexity(scene.executor), 3.5 * std::max(first, last)) << i;
    }
  }
}

TYPED_TEST(MetricPathIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  Scene<Dim> one(1, 50);
  auto path = one.path(true);
  for (const int threads : test::thread_counts) {
    Scene<Dim> many(threads, 50);
    auto other = many.path(true);
    ASSERT_EQ(other.steps(), path.steps());
    for (int i = 0; i <= path.steps(); ++i) {
      path.go_to(i);
      other.go_to(i);
      EXPECT_EQ(many.log_metrics(), one.log_metrics()) << i;
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::metric_path_test
