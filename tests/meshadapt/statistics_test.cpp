#include "ductile/meshadapt/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "ductile/meshadapt/metric_field.hpp"
#include "io_support.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::statistics_test {
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

/// Ideal elements of many sizes and directions do not exceed the ideal by rounding.
TEST(Statistics, NothingIsBetterThanIdeal) {
  const Executor executor({.threads = 1});
  test::Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    AnyMesh flat;
    flat.dimension = 2;
    flat.coordinates = {0, 0, 1, 0, 0.5, std::sqrt(3.0) / 2};
    flat.vertex_reference = {0, 0, 0};
    flat.triangles.add({0, 1, 2}, 1);
    AnyMesh solid = one_tetrahedron(std::sqrt(2.0 / 3));
    for (AnyMesh* mesh : {&flat, &solid}) {
      test::place(*mesh, random, test::uniform(random, 0.1, 1), 0);
      const Distribution quality = measure(executor, *mesh, nullptr).quality;
      EXPECT_LE(quality.max, 1);
      EXPECT_EQ(quality.above, 0U);
      EXPECT_EQ(quality.histogram[9], 1U);
    }
  }
}

TEST(Statistics, AnInvertedElementIsNegativeAndAFlatOneZero) {
  const Executor executor({.threads = 1});
  EXPECT_NEAR(measure(executor, one_tetrahedron(-std::sqrt(2.0 / 3)), nullptr).quality.min, -1,
              1e-14);
  EXPECT_EQ(measure(executor, one_tetrahedron(0), nullptr).quality.min, 0);
}

TEST(Statistics, AnElementWhoseCornersAreOnePointHasNoQuality) {
  AnyMesh mesh = one_tetrahedron(0);
  mesh.coordinates.assign(12, 0.5);
  const MeshStatistics s = measure(Executor({.threads = 1}), mesh, nullptr);
  EXPECT_EQ(s.quality.min, 0);
  EXPECT_EQ(s.quality.max, 0);
  EXPECT_EQ(s.quality.mean, 0);
  EXPECT_EQ(s.edge_length.max, 0);
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
  // The longest edge goes from (0, 0), where its length is 1, to (1, 0), where it is 4.
  EXPECT_NEAR(s.edge_length.max, 3 / std::log(4.0), 1e-12);
}

TEST(Statistics, RefuseArraysThatDoNotFit) {
  const Executor executor({.threads = 1});
  AnyMesh mesh = grid(2);
  const auto complaint = [&](const AnyField* metric) {
    auto of_qualities = test::complaint([&] { element_qualities(executor, mesh, metric); });
    EXPECT_EQ(test::complaint([&] { measure(executor, mesh, metric); }), of_qualities);
    return of_qualities;
  };
  AnyField metric = constant_metric(mesh, 1);
  metric.name = "a.sol";
  metric.values.pop_back();
  EXPECT_NE(complaint(&metric).find("a.sol: expected numbers"), std::string::npos);
  EXPECT_NE(complaint(&metric).find("27 of them, found 26"), std::string::npos);
  metric = constant_metric(grid(1), 1);
  EXPECT_NE(complaint(&metric).find("expected 9 values"), std::string::npos);
  EXPECT_NE(complaint(&metric).find("found 4"), std::string::npos);
  metric = {2, 9, {AnyField::Type::scalar}, std::vector<double>(9, 1.0), "h.sol"};
  EXPECT_NE(complaint(&metric).find("symmetric tensors, found one of another"), std::string::npos);
  mesh.coordinates.pop_back();
  EXPECT_NE(complaint(nullptr).find("each of the 9 vertices, found 17"), std::string::npos);
}

TEST(Statistics, RefuseElementsOfVerticesThatAreNotThere) {
  const runtime::Executor executor({.threads = 2});
  for (const int dimension : {2, 3}) {
    AnyMesh mesh = test::make_grid(test::unit_grid(dimension, 2));
    (dimension == 2 ? mesh.triangles.vertices[3][1] : mesh.tetrahedra.vertices[3][1]) = 5000;
    EXPECT_THROW(measure(executor, mesh, nullptr), InputError);
    EXPECT_THROW(element_qualities(executor, mesh, nullptr), InputError);
  }
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

/// n triangles around vertex `hub`, which has more neighbours than are searched one by one.
AnyMesh fan(std::uint32_t n, std::uint32_t hub) {
  AnyMesh mesh;
  mesh.dimension = 2;
  std::vector<std::uint32_t> rim;
  for (std::uint32_t v = 0; v <= n; ++v) {
    const double angle = 2 * std::numbers::pi * v / n;
    mesh.coordinates.push_back(v == hub ? 0 : std::cos(angle));
    mesh.coordinates.push_back(v == hub ? 0 : std::sin(angle));
    mesh.vertex_reference.push_back(0);
    if (v != hub) rim.push_back(v);
  }
  for (std::size_t i = 0; i < rim.size(); ++i)
    mesh.triangles.add({hub, rim[i], rim[(i + 1) % rim.size()]}, 1);
  return mesh;
}

std::size_t edge_count(const AnyMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  const auto add = [&](const auto& corners) {
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners)
        if (a < b) edges.emplace(a, b);
  };
  for (const auto& corners : mesh.triangles.vertices)
    if (mesh.dimension == 2) add(corners);
  for (const auto& corners : mesh.tetrahedra.vertices) add(corners);
  return edges.size();
}

TEST(Statistics, FindsEveryEdgeHoweverVerticesAreNumbered) {
  std::mt19937_64 random(17);
  std::vector<AnyMesh> meshes{grid(40), fan(300, 0), fan(300, 300), fan(300, 123)};
  for (const int dimension : {2, 3}) {
    meshes.push_back(test::make_grid(test::unit_grid(dimension, 9)));
    AnyMesh& shuffled = meshes.emplace_back(meshes.back());
    std::vector<std::uint32_t> number(shuffled.vertex_count());
    std::iota(number.begin(), number.end(), 0U);
    std::shuffle(number.begin(), number.end(), random);
    for (auto& corners : shuffled.triangles.vertices)
      for (std::uint32_t& v : corners) v = number[v];
    for (auto& corners : shuffled.tetrahedra.vertices)
      for (std::uint32_t& v : corners) v = number[v];
  }
  for (const AnyMesh& mesh : meshes)
    for (const int threads : {1, 2, 8})
      EXPECT_EQ(measure(Executor({.threads = threads}), mesh, nullptr).edge_length.count,
                edge_count(mesh));
}

TEST(Distribution, IsThatOfTheSortedValues) {
  std::mt19937_64 random(23);
  for (int trial = 0; trial < 84; ++trial) {
    std::vector<double> values(1 + random() % (trial < 35 ? 50 : trial < 70 ? 20000 : 300000));
    const int kind = trial % 7;
    for (double& value : values) {
      value = std::generate_canonical<double, 53>(random);
      if (kind == 1) value = 0.5;                          // all equal
      if (kind == 2) value = std::floor(5 * value) / 4;    // on bounds of bins, one beyond
      if (kind == 3) value = std::pow(value, 40) * 1e9;    // most in one bin
      if (kind == 4) value = (value - 0.5) * 1e308 * 1.9;  // a range that overflows
      if (kind == 5) value = value < 0.1 ? -1 - value : value;
      if (kind == 6)
        value = value < 0.9 ? 1 + value * 1e-12 : 1e-300 + value;  // narrow, few outliers
    }
    const Distribution d =
        distribution(Executor({.threads = 1 + static_cast<int>(random() % 4)}), values, 0, 1);
    std::sort(values.begin(), values.end());
    const auto at_rank = [&](double share) {
      const double rank = std::ceil(share * static_cast<double>(values.size()));
      return values[static_cast<std::size_t>(rank) - 1];
    };
    EXPECT_EQ(d.count, values.size());
    EXPECT_EQ(d.min, values.front());
    EXPECT_EQ(d.max, values.back());
    EXPECT_EQ(d.low, at_rank(0.01));
    EXPECT_EQ(d.median, at_rank(0.5));
    const auto below = [&](double bound) {
      const auto end = std::lower_bound(values.begin(), values.end(), bound);
      return static_cast<std::size_t>(end - values.begin());
    };
    const std::size_t above = values.size() - below(std::nextafter(1.0, 2.0));
    EXPECT_EQ(d.below, below(0));
    EXPECT_EQ(d.above, above);
    const double width = 0.1;
    for (std::size_t bin = 0; bin < 9; ++bin)
      EXPECT_EQ(d.histogram[bin],
                below(width * static_cast<double>(bin + 1)) -
                    (bin == 0 ? below(0) : below(width * static_cast<double>(bin))));
    EXPECT_EQ(d.histogram[9], values.size() - above - below(width * 9));
  }
}

TEST(Distribution, EndsEvenIfValuesAreNotNumbers) {
  const Executor executor({.threads = 2});
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const double other : {none, -none, 0.5, 1e300})
    for (const std::size_t n : {1U, 100U, 200000U}) {
      std::vector<double> values(n, none);
      for (std::size_t i = 0; i < n; i += 2) values[i] = other;
      EXPECT_EQ(distribution(executor, values, 0, 1).count, n);
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
}  // namespace ductile::meshadapt::statistics_test
