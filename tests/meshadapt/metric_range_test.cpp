/// @file
/// The library accepts every metric that it returns, also at the limits of its range.
#include "metric/metric_range.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::metric_range_test {
namespace {

using test::below;
using test::chance;
using test::Random;
using test::uniform;

const runtime::Executor executor({.threads = 2});

template <class Dimension>
class MetricRangeIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MetricRangeIn, Dimensions, );

/// A metric of about this size with a stretch up to the bound, axis-parallel or rotated.
template <int Dim>
Metric<Dim> extreme_metric(Random& random, double size) {
  const double stretch = chance(random, 0.4) ? 1e8 : std::pow(10, uniform(random, 0, 8));
  std::array<double, Dim> sizes;
  for (double& s : sizes) s = size * std::pow(stretch, -uniform(random, 0, 1));
  sizes[0] = size;
  sizes[Dim - 1] = size / stretch;
  if (chance(random, 0.5)) return test::random_metric<Dim>(random, sizes);
  Metric<Dim> metric;
  for (std::size_t i = 0; i < Dim; ++i) metric.m[i * (i + 3) / 2] = 1 / (sizes[i] * sizes[i]);
  return metric;
}

TYPED_TEST(MetricRangeIn, BringsWhatRoundingMadeOfAMetricBack) {
  constexpr int Dim = TypeParam::value;
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto metric = extreme_metric<Dim>(random, std::pow(10, uniform(random, -60, 70)));
    const Metric<Dim> brought = brought_into_range(metric);
    ASSERT_TRUE(in_range(brought)) << i;
    if (in_range(metric)) {
      ASSERT_EQ(brought, metric);
    }
    ASSERT_EQ(brought_into_range(brought), brought);
    // The short sizes are kept.
    const auto before = principal_axes(metric).value, after = principal_axes(brought).value;
    const double most = *std::max_element(before.begin(), before.end());
    ASSERT_NEAR(*std::max_element(after.begin(), after.end()) / most, 1, 1e-9);
  }
}

/// A grid of one or a few cells, of any scale, and a metric that asks for about as many elements.
template <int Dim>
struct Extreme {
  AnyMesh mesh;
  AnyField metric;

  explicit Extreme(Random& random) : mesh(test::make_grid(test::unit_grid(Dim, 2))) {
    const double scale = std::pow(10, uniform(random, -45, 45));
    for (double& x : mesh.coordinates) x *= scale;
    const double longest = scale * std::pow(10, uniform(random, 0.3, chance(random, 0.3) ? 25 : 1));
    metric = test::metric_field<Dim>(mesh, [&](std::uint32_t) {
      // Limits the stretch, which could otherwise lead to millions of elements.
      const double stretch = std::min(1e8, std::pow(10, uniform(random, 0, 1.5)) * longest / scale);
      std::array<double, Dim> sizes;
      sizes.fill(longest / stretch);
      sizes[0] = longest;
      return chance(random, 0.5) ? brought_into_range(test::random_metric<Dim>(random, sizes))
                                 : brought_into_range(axis_aligned(sizes));
    });
  }

  static Metric<Dim> axis_aligned(const std::array<double, Dim>& sizes) {
    Metric<Dim> metric;
    for (std::size_t i = 0; i < Dim; ++i) metric.m[i * (i + 3) / 2] = 1 / (sizes[i] * sizes[i]);
    return metric;
  }
};

TYPED_TEST(MetricRangeIn, WhateverAdaptReturnsItTakesAgain) {
  constexpr int Dim = TypeParam::value;
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("metric_range_" + std::to_string(Dim));
  std::filesystem::create_directories(folder);
  Random random(2);
  std::uint64_t taken = 0;
  const std::uint64_t count = test::trials(100);
  for (std::uint64_t i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    const Extreme<Dim> extreme(random);
    AdaptOptions options{.iterations = 3};
    if (chance(random, 0.2)) options.gradation = uniform(random, 1, 3);
    AdaptedMesh once;
    try {
      once = adapt(executor, extreme.mesh, metric_of(extreme.metric, extreme.mesh), options);
    } catch (const InputError&) {
      continue;
    }
    ++taken;
    ASSERT_NO_THROW(metric_of(once.metric, once.mesh));
    ASSERT_NO_THROW(adapt(executor, once.mesh, once.metric, options));
    for (const char* name : {"m.sol", "m.solb"}) {
      const int version = 2 + static_cast<int>(below(random, 3));
      write_field(folder / name, once.metric, {.version = version});
      const AnyField read = read_field(folder / name);
      ASSERT_EQ(read.values, once.metric.values);
      ASSERT_NO_THROW(metric_of(read, once.mesh));
    }
  }
  if (count >= 100) {
    EXPECT_GT(taken, count / 2);
  }
  std::filesystem::remove_all(folder);
}

TYPED_TEST(MetricRangeIn, WhateverOperationsReturnTheyTakeAgain) {
  constexpr int Dim = TypeParam::value;
  Random random(3);
  const AnyMesh mesh = test::make_grid(test::unit_grid(Dim, 2));
  const FixedMesh<Dim> fixed = make_fixed_mesh<Dim>(executor, mesh);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    std::vector<Metric<Dim>> a, b;
    const double size = std::pow(10, uniform(random, -60, 60));
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      a.push_back(brought_into_range(extreme_metric<Dim>(random, size)));
      b.push_back(brought_into_range(extreme_metric<Dim>(random, size)));
    }
    ASSERT_NO_THROW(intersect(executor, a, b));
    ASSERT_NO_THROW(bound_sizes(executor, a, {.anisotropy = 1e8}));
    ASSERT_NO_THROW(limit_gradation(executor, a, fixed, {.factor = 2, .sweeps = 20}));
    ASSERT_NO_THROW(bound_sizes(executor, a, {.smallest = size * 1e-5, .largest = size * 1e3}));
    const AnyField field = symmetric_field(executor, a, "");
    ASSERT_NO_THROW(metric_of(field, mesh));
  }
}

}  // namespace
}  // namespace ductile::meshadapt::metric_range_test
