#include "adapt/processor_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::processor_level_test {
namespace {

using runtime::Executor;
using test::bits;

/// adapt() to this metric at a level.
AdaptedMesh adapt_to(ProcessorLevel level, const Executor& executor, const AnyMesh& mesh,
                     const AnyField& metric, const AdaptOptions& options) {
  struct Source : MetricSource {
    explicit Source(const AnyField& given) : metric(given) {}
    const AnyField* next(const AdaptState& state) override {
      return state.pass == 0 ? &metric : nullptr;
    }
    const AnyField& metric;
  } source(metric);
  return adapt_at(level, executor, mesh, source, options);
}

TEST(ProcessorLevel, BestComesFirstAndAsBuiltIsAlwaysThere) {
  const std::vector<ProcessorLevel> levels = usable_levels();
  ASSERT_FALSE(levels.empty());
  EXPECT_EQ(levels.back(), ProcessorLevel::as_built);
  EXPECT_TRUE(std::is_sorted(levels.rbegin(), levels.rend()));
  EXPECT_EQ(std::adjacent_find(levels.begin(), levels.end()), levels.end());
}

/// Both dimensions.
class ProcessorLevelOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, ProcessorLevelOf, testing::Values(2, 3),
                         [](const auto& at) { return std::to_string(at.param) + "D"; });

TEST_P(ProcessorLevelOf, AllGiveTheSameBytes) {
  const int dimension = GetParam();
  if (usable_levels().size() == 1) GTEST_SKIP() << "there is one level only";
  AnyMesh mesh = test::make_grid(test::unit_grid(dimension, dimension == 2 ? 12 : 5));
  test::Random random(11);
  test::jiggle(mesh, random, 0.2);
  AnyField metric = test::layer_field(mesh, random, 0.05);
  test::scale_to(metric, mesh, dimension == 2 ? 1500 : 700);
  const Executor executor({.threads = 2});
  const AdaptOptions options{.smallest_size = 0.01, .largest_size = 0.3, .gradation = 1.5};
  const AdaptedMesh expected = adapt_to(ProcessorLevel::as_built, executor, mesh, metric, options);
  EXPECT_EQ(expected.report.instructions, "as built");
  for (const ProcessorLevel level : usable_levels()) {
    SCOPED_TRACE(name_of(level));
    const AdaptedMesh result = adapt_to(level, executor, mesh, metric, options);
    EXPECT_EQ(result.report.instructions, name_of(level));
    EXPECT_EQ(bits(result.mesh.coordinates), bits(expected.mesh.coordinates));
    EXPECT_TRUE(result.mesh == expected.mesh);
    EXPECT_EQ(bits(result.metric.values), bits(expected.metric.values));
  }
}

TEST_P(ProcessorLevelOf, WhatTheyThrowIsCaughtByItsType) {
  AnyMesh mesh = test::make_grid(test::unit_grid(GetParam(), 2));
  const AnyField metric = constant_metric(mesh, 0.3);
  (GetParam() == 2 ? mesh.triangles.vertices[1][0] : mesh.tetrahedra.vertices[1][0]) = 1000;
  for (const ProcessorLevel level : usable_levels())
    EXPECT_THROW(adapt_to(level, Executor({.threads = 2}), mesh, metric, {}), InputError)
        << name_of(level);
}

TEST_P(ProcessorLevelOf, AdaptUsesTheBest) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(GetParam(), 3));
  test::Random random(5);
  const AnyField metric = test::layer_field(mesh, random, 0.2);
  EXPECT_EQ(adapt(Executor({.threads = 1}), mesh, metric).report.instructions,
            name_of(usable_levels().front()));
}

}  // namespace
}  // namespace ductile::meshadapt::processor_level_test
