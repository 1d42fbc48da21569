#include <gtest/gtest.h>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::approach_only_test {
namespace {

using runtime::Executor;

class ApproachOnly : public testing::TestWithParam<int> {
 protected:
  AnyMesh fine() const {
    return test::make_grid(test::unit_grid(GetParam(), GetParam() == 2 ? 40 : 12));
  }
  static std::size_t elements_of(const AnyMesh& mesh) {
    return mesh.dimension == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
  }
};

TEST_P(ApproachOnly, CoarsensInOneRoundOfCollapses) {
  const AnyMesh mesh = fine();
  const AnyField metric = constant_metric(mesh, 0.3);
  const AdaptOptions options{.iterations = 1, .move = false, .swap = false, .approach_only = true};
  const AdaptedMesh first = adapt(Executor({.threads = 1}), mesh, metric, options);
  EXPECT_LT(3 * elements_of(first.mesh), elements_of(mesh));
  EXPECT_EQ(first.report.iterations, 1);
  EXPECT_EQ(first.report.swap.applied + first.report.smooth.applied, 0U);
  const auto faults = test::faults_of(Executor(), mesh, first);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  for (const int threads : {2, 8}) {
    SCOPED_TRACE(threads);
    const AdaptedMesh again = adapt(Executor({.threads = threads}), mesh, metric, options);
    EXPECT_EQ(test::bits(again.mesh.coordinates), test::bits(first.mesh.coordinates));
    EXPECT_EQ(again.mesh.tetrahedra.vertices, first.mesh.tetrahedra.vertices);
    EXPECT_EQ(again.mesh.triangles.vertices, first.mesh.triangles.vertices);
  }
}

TEST_P(ApproachOnly, LeavesOutWhatFollows) {
  const AnyMesh mesh = fine();
  const AnyField metric = constant_metric(mesh, GetParam() == 2 ? 0.01 : 0.1);
  const Executor executor({.threads = 2});
  const AdaptedMesh rough = adapt(executor, mesh, metric, {.approach_only = true});
  const AdaptedMesh whole = adapt(executor, mesh, metric);
  EXPECT_TRUE(rough.report.converged);
  EXPECT_LT(rough.report.smooth.considered, whole.report.smooth.considered);
  EXPECT_LT(rough.report.swap.considered, whole.report.swap.considered);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, ApproachOnly, testing::Values(2, 3));

}  // namespace
}  // namespace ductile::meshadapt::approach_only_test
