#include "ductile/meshadapt/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ductile/meshadapt/default_metric.hpp"

namespace ductile::meshadapt {
namespace {

using runtime::Executor;

/// A grid of n x n squares, each cut into two triangles, over the unit square.
AnyMesh grid(std::uint32_t n) {
  AnyMesh mesh;
  mesh.dimension = 2;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      mesh.coordinates.push_back(static_cast<double>(i) / n);
      mesh.coordinates.push_back(static_cast<double>(j) / n);
      mesh.vertex_reference.push_back(0);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.add({a, b, d}, 1);
      mesh.triangles.add({a, d, c}, 1);
    }
  }
  return mesh;
}

AnyMesh one_tetrahedron(double height) {
  AnyMesh mesh;
  mesh.dimension = 3;
  const double h = std::sqrt(3.0) / 2;
  mesh.coordinates = {0, 0, 0, 1, 0, 0, 0.5, h, 0, 0.5, h / 3, height};
  mesh.vertex_reference = {0, 0, 0, 0};
  mesh.tetrahedra.add({0, 1, 2, 3}, 1);
  return mesh;
}

TEST(Statistics, TheRegularElementIsIdeal) {
  const Executor executor({.threads = 1});
  const MeshStatistics s = measure(executor, one_tetrahedron(std::sqrt(2.0 / 3)), nullptr);
  EXPECT_NEAR(s.quality.min, 1, 1e-14);
  EXPECT_NEAR(s.edge_length.max, 1, 1e-14);
  EXPECT_EQ(s.edge_length.count, 6U);
  EXPECT_FALSE(s.in_metric);
}

TEST(Statistics, AnInvertedElementIsNegativeAndAFlatOneZero) {
  const Executor executor({.threads = 1});
  EXPECT_NEAR(measure(executor, one_tetrahedron(-std::sqrt(2.0 / 3)), nullptr).quality.min, -1,
              1e-14);
  EXPECT_EQ(measure(executor, one_tetrahedron(0), nullptr).quality.min, 0);
}

TEST(Statistics, CountsEachEdgeOnceAndSortsThemByLength) {
  const Executor executor({.threads = 2});
  const AnyMesh mesh = grid(10);
  const AnyField metric = constant_metric(mesh, 0.1);
  const MeshStatistics s = measure(executor, mesh, &metric);
  EXPECT_EQ(s.edge_length.count, 2U * 110 + 100);
  EXPECT_EQ(s.edges_in_range + s.edges_short + s.edges_long, s.edge_length.count);
  EXPECT_NEAR(s.edge_length.min, 1, 1e-12);
  EXPECT_NEAR(s.edge_length.max, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(s.quality.mean, std::sqrt(3.0) / 2, 1e-12);
  EXPECT_NEAR(s.complexity, 100, 1e-9);
}

TEST(Statistics, EdgeLengthIsTheLogarithmicMeanOfBothEnds) {
  const Executor executor({.threads = 1});
  AnyMesh mesh = grid(1);
  AnyField metric = constant_metric(mesh, 1);
  for (std::size_t component = 3; component < 6; ++component) metric.values[component] *= 16;
  const MeshStatistics s = measure(executor, mesh, &metric);
  // The edge from (0, 0), where it is 1 long, to (1, 0), where it is 4 long.
  EXPECT_NEAR(s.edge_length.max, 3 / std::log(4.0), 1e-12);
}

TEST(Statistics, AreTheSameAtEachThreadCount) {
  const AnyMesh mesh = grid(60);
  const AnyField metric = implied_metric(mesh);
  const MeshStatistics one = measure(Executor({.threads = 1}), mesh, &metric);
  for (const int threads : {2, 8}) {
    const MeshStatistics many = measure(Executor({.threads = threads}), mesh, &metric);
    EXPECT_EQ(one.quality.mean, many.quality.mean);
    EXPECT_EQ(one.edge_length.mean, many.edge_length.mean);
    EXPECT_EQ(one.complexity, many.complexity);
    EXPECT_EQ(one.edge_length.histogram, many.edge_length.histogram);
  }
}

TEST(Distribution, TakesPercentilesByNearestRank) {
  const Executor executor({.threads = 1});
  std::vector<double> values;
  for (int i = 200; i >= 1; --i) values.push_back(i);
  const Distribution d = distribution(executor, values, 0, 100);
  EXPECT_EQ(d.low, 2);
  EXPECT_EQ(d.median, 100);
  EXPECT_EQ(d.mean, 100.5);
  EXPECT_EQ(d.above, 100U);
  EXPECT_EQ(d.histogram[0], 9U);   // 1 to 9; 10 is in the next
  EXPECT_EQ(d.histogram[9], 11U);  // 90 to 100, the end included
  EXPECT_EQ(distribution(executor, {}, 0, 1).count, 0U);
}

TEST(DefaultMetric, ImpliedSizesAreThoseOfTheMesh) {
  const Executor executor({.threads = 1});
  const AnyMesh mesh = grid(8);
  const AnyField metric = implied_metric(mesh);
  const MeshStatistics s = measure(executor, mesh, &metric);
  EXPECT_NEAR(s.edge_length.mean, 1, 0.05);
  EXPECT_EQ(s.edges_in_range, s.edge_length.count);
}

}  // namespace
}  // namespace ductile::meshadapt
