#include "operators/smooth.hpp"

#include <gtest/gtest.h>

#include "ductile/meshadapt/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt {
namespace {

using runtime::Executor;
using test::Random;

template <class Dimension>
class SmoothIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SmoothIn, Dimensions);

/// The metric that asks for the size 1 in a plane and for a smaller one along its normal.
template <int Dim>
Metric<Dim> layer(const Vector<Dim>& normal, double thin) {
  Metric<Dim> metric;
  const double along = 1, across = 1 / (thin * thin) - along;
  std::size_t k = 0;  // lower triangle by rows
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j)
      metric.m[k++] = across * normal[i] * normal[j] + (i == j ? along : 0);
  return metric;
}

/// Where shapes would gain most by leaving the patch, what rounding leaves of the direction within
/// it must not be scaled up to a step.
TYPED_TEST(SmoothIn, KeepsVerticesOnTheirPatches) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Random random(5);
  std::size_t moves = 0;
  for (int trial = 0; trial < 60; ++trial) {
    AnyMesh any = test::make_grid(test::unit_grid(Dim, 4));
    test::jiggle(any, random, 0.3);
    test::place(any, random, 1, 1);
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
    const Vector<Dim>& normal = mesh.patches.back().normal;
    const std::vector<Metric<Dim>> metric_of(
        mesh.vertex_slots(), layer<Dim>(normal, std::pow(10.0, test::uniform(random, -3, 0))));
    for (std::size_t v = 0; v < mesh.vertex_slots(); ++v)
      mesh.site_of[v] = make_site(mesh.site_of[v].position, metric_of[v]);
    update_shapes(executor, mesh);
    const Background<Dim> background(executor, mesh, std::move(neighbours));
    const Smooth<Dim> op(mesh, background, {.laplacian = trial % 2 == 0, .optimise_below = 1});
    for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
      const auto v = static_cast<VertexId>(i);
      if (mesh.kind_of[v].freedom != Dim - 1) continue;
      const auto plan = op.plan(v);
      if (!plan) continue;
      ++moves;
      const Vector<Dim> step = plan->site.position - mesh.site_of[v].position;
      EXPECT_LT(std::abs(dot(step, mesh.patches[mesh.entity_of[v]].normal)), 1e-14);
    }
  }
  EXPECT_GT(moves, 100U);
}

}  // namespace
}  // namespace ductile::meshadapt
