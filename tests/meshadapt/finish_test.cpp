/// @file
/// The result of a run: lengths are within the rules wherever these allow, also next to required
/// edges that are far shorter than their size.
#include <gtest/gtest.h>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "operators/edge_range.hpp"
#include "operators/standing.hpp"
#include "support/preserved.hpp"
#include "support/short_edges.hpp"

namespace ductile::meshadapt::finish_test {
namespace {

using runtime::Executor;

/// Some longer edges stay, next to elements that are thin because a required edge is short.
void expect_no_edge_above(double limit, int dimension, std::uint64_t cases) {
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    const auto made = test::short_edge_case(dimension, seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + made.what);
    const AdaptedMesh result = adapt(executor, made.mesh, made.metric);
    const auto faults = test::faults_of(executor, made.mesh, result);
    EXPECT_TRUE(faults.empty()) << test::joined(faults);
    const MeshStatistics found = measure(executor, result.mesh, &result.metric);
    EXPECT_LT(found.edge_length.max, limit);
  }
}

TEST(Finish, LeavesNoLongEdgesNextToShortRequiredOnesIn2D) { expect_no_edge_above(1.55, 2, 60); }
TEST(Finish, LeavesNoLongEdgesNextToShortRequiredOnesIn3D) { expect_no_edge_above(1.75, 3, 24); }

EndSquares edge_of_length(double length) { return {length * length, length * length}; }

TEST(EdgeRange, LetsEdgesComeCloserButNotGoAway) {
  const EdgeRange range{0.7, 1.4};
  const auto accepts = [&](double after, double before) {
    return range.accepts(edge_of_length(after), edge_of_length(before));
  };
  EXPECT_TRUE(accepts(1, 1));
  EXPECT_TRUE(accepts(1, 5));
  EXPECT_TRUE(accepts(2, 2.5));
  EXPECT_FALSE(accepts(2.5, 2));
  EXPECT_FALSE(accepts(1.5, 1.3));
  EXPECT_TRUE(accepts(0.5, 0.4));
  EXPECT_FALSE(accepts(0.4, 0.5));
  EXPECT_FALSE(accepts(0.6, 0.8));
  EXPECT_FALSE(EdgeRange{}.is_bounded());
  EXPECT_TRUE(EdgeRange{}.accepts(edge_of_length(9), edge_of_length(1)));
}

TEST(Standing, IsBetterOnlyIfItClearlyIs) {
  const Standing before{.elements = 1000, .qualities = 100, .lengths = 50, .poor = 40};
  const Standing hardly{.elements = 1000, .qualities = 100, .lengths = 44, .poor = 40};
  EXPECT_FALSE(is_better(hardly, before, after_a_run));
  EXPECT_TRUE(is_better(hardly, before, after_mending));
  EXPECT_FALSE(is_better(before, before, after_a_run));
  EXPECT_FALSE(is_better({.elements = 1000, .qualities = 95, .lengths = 47, .poor = 36}, before,
                         after_a_run));
  EXPECT_TRUE(is_better({.elements = 1000, .qualities = 80, .lengths = 50, .poor = 40}, before,
                        after_a_run));
  EXPECT_TRUE(is_better({.elements = 1000, .qualities = 100, .lengths = 30, .poor = 40}, before,
                        after_a_run));
  EXPECT_FALSE(is_better({.elements = 1000, .qualities = 110, .lengths = 30, .poor = 40}, before,
                         after_a_run));
  EXPECT_TRUE(is_better({.elements = 1000, .qualities = 100, .lengths = 50, .poor = 10}, before,
                        after_a_run));
  EXPECT_TRUE(is_better({.elements = 2000, .qualities = 160, .lengths = 60, .poor = 80}, before,
                        after_a_run));
}

}  // namespace
}  // namespace ductile::meshadapt::finish_test
