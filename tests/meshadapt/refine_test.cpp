#include "operators/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ductile/meshadapt/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt {
namespace {

using runtime::Executor;
using test::Random;

template <class Dimension>
class RefineIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RefineIn, Dimensions);

/// A metric with random axes, sizes and stretch at every vertex of a random mesh.
template <int Dim>
Mesh<Dim> wild_mesh(const Executor& executor, Random& random, Neighbours<Dim>& neighbours) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 3));
  test::jiggle(any, random, 0.3);
  std::vector<std::string> warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (auto& site : mesh.site_of) {
    std::array<double, Dim> sizes;
    for (double& size : sizes) size = std::pow(10.0, test::uniform(random, -1.5, 0.5));
    site = make_site(site.position, test::random_metric<Dim>(random, sizes));
  }
  update_shapes(executor, mesh);
  return mesh;
}

/// Where the metric changes a lot along an edge, the shapes before and after a split have little to
/// do with each other: edges much too long must not wait for good ones.
TYPED_TEST(RefineIn, SplitsOverlongEdgesIntoWorseShapes) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Random random(11);
  Rules patient;
  patient.overlong_edge = std::numeric_limits<double>::infinity();
  std::size_t either_way = 0, overlong_only = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Neighbours<Dim> neighbours;
    Mesh<Dim> mesh = wild_mesh<Dim>(executor, random, neighbours);
    const Background<Dim> background(executor, mesh, std::move(neighbours));
    const Rules rules;
    const Refine<Dim> op(mesh, background, rules), patient_op(mesh, background, patient);
    for (const LongEdge& edge : Refine<Dim>::long_edges(executor, mesh, rules.long_edge, 0)) {
      const bool splits = op.plan(edge).has_value();
      const bool patiently_splits = patient_op.plan(edge).has_value();
      if (edge.length <= rules.overlong_edge)
        EXPECT_EQ(splits, patiently_splits);
      else
        EXPECT_GE(splits, patiently_splits);
      either_way += patiently_splits;
      overlong_only += splits && !patiently_splits;
    }
  }
  EXPECT_GT(either_way, 100U);
  EXPECT_GT(overlong_only, 20U);
}

}  // namespace
}  // namespace ductile::meshadapt
