#include "operators/smooth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "geometry/make_mesh.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::smooth_test {
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

/// Where leaving the patch would improve qualities most, the direction within the patch is lost to
/// rounding. It must not be scaled up to a step.
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
    update_qualities(executor, mesh);
    const Background<Dim> background(executor, mesh, std::move(neighbours));
    const Smooth<Dim> op(mesh, background, {.laplacian = trial % 2 == 0, .optimise_below = 1});
    for (std::size_t i = 0; i < mesh.vertex_slots(); ++i) {
      const auto v = static_cast<VertexId>(i);
      if (mesh.kind_of[v].class_dimension != Dim - 1) continue;
      VertexMove<Dim> move;
      if (!op.decide(v, move)) continue;
      ++moves;
      const Vector<Dim> step = move.site.position - mesh.site_of[v].position;
      EXPECT_LT(std::abs(dot(step, mesh.patches[mesh.entity_of[v]].normal)), 1e-14);
    }
  }
  EXPECT_GT(moves, 100U);
}

template <int Dim>
struct SmoothScene {
  Mesh<Dim> mesh;
  std::unique_ptr<Background<Dim>> background;

  /// Unit metric everywhere.
  SmoothScene(const Executor& executor, const AnyMesh& any) {
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    mesh = make_mesh<Dim>(executor, any, {.complete_boundary = true}, neighbours, warnings);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      mesh.site_of[v] = make_site(mesh.site_of[v].position, isotropic<Dim>(1));
      mesh.host_of[v] = mesh.elements_of.of(v).front();
    }
    update_qualities(executor, mesh);
    background = std::make_unique<Background<Dim>>(executor, mesh, std::move(neighbours));
  }
};

TYPED_TEST(SmoothIn, ConflictsWithAllNeighbours) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Random random(7);
  test::Grid grid = test::unit_grid(Dim, 6);
  grid.region = test::with_hole(6);
  AnyMesh any = test::make_grid(grid);
  test::jiggle(any, random, 0.2);
  SmoothScene<Dim> scene(executor, any);
  const Smooth<Dim> op(scene.mesh, *scene.background, {});
  for (VertexId v = 0; v < scene.mesh.vertex_slots(); ++v) {
    std::set<VertexId> found, expected;
    op.conflicts(v, [&](VertexId other) { found.insert(other); });
    for (const ElementId e : scene.mesh.elements_of.of(v))
      expected.insert(scene.mesh.corners_of[e].begin(), scene.mesh.corners_of[e].end());
    expected.erase(v);
    EXPECT_EQ(found, expected);
    const auto neighbours = neighbours_of(scene.mesh, v);
    EXPECT_EQ(std::set<VertexId>(neighbours.begin(), neighbours.end()), expected);
    EXPECT_EQ(neighbours.size(), expected.size());
  }
}

/// A disc of 30 triangles around an off-centre vertex; 3D: two cones of tetrahedra on it.
template <int Dim>
AnyMesh wheel() {
  constexpr std::uint32_t rim = 30, top = rim + 1, bottom = rim + 2;
  AnyMesh any;
  any.dimension = Dim;
  const auto add = [&](const std::array<double, 3>& p) {
    any.coordinates.insert(any.coordinates.end(), p.begin(), p.begin() + Dim);
    any.vertex_reference.push_back(0);
  };
  add({0.4, 0.3, 0.1});
  for (std::uint32_t i = 0; i < rim; ++i) {
    const double angle = 2 * std::numbers::pi * i / rim;
    add({std::cos(angle), std::sin(angle), 0});
  }
  if (Dim == 3) add({0, 0, 1}), add({0, 0, -1});
  for (std::uint32_t i = 0; i < rim; ++i) {
    const std::uint32_t a = 1 + i, b = 1 + (i + 1) % rim;
    if (Dim == 2) any.triangles.vertices.push_back({0, a, b});
    if (Dim == 3) any.tetrahedra.vertices.push_back({0, a, b, top});
    if (Dim == 3) any.tetrahedra.vertices.push_back({0, b, a, bottom});
  }
  any.triangles.reference.resize(any.triangles.vertices.size());
  any.tetrahedra.reference.resize(any.tetrahedra.vertices.size());
  return any;
}

/// The ball has more elements than a plan can store qualities for.
TYPED_TEST(SmoothIn, KeepsTheQualitiesOfALargeBallUpToDate) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  SmoothScene<Dim> scene(executor, wheel<Dim>());
  ASSERT_GT(scene.mesh.elements_of.of(0).size(), std::size_t{BallQualities<Dim>::most});
  const Vector<Dim> before = scene.mesh.site_of[0].position;
  Smooth<Dim> op(scene.mesh, *scene.background, {});
  for (int sweep = 0; sweep < 10; ++sweep)
    runtime::run_rounds_by<runtime::Strategy::tiles>(executor, op, std::vector<VertexId>{0});
  EXPECT_LT(norm(scene.mesh.site_of[0].position), 0.5 * norm(before));
  EXPECT_TRUE(check_mesh(executor, scene.mesh).empty());
}

/// Sum of the inverse qualities around a vertex, if it were at this site.
template <int Dim>
double inverse_qualities(Mesh<Dim>& mesh, VertexId vertex, const Site<Dim>& site) {
  const Site<Dim> before = std::exchange(mesh.site_of[vertex], site);
  double sum = 0;
  for (const ElementId e : mesh.elements_of.of(vertex))
    sum += 1 / mesh.quality_at(mesh.corners_of[e]);
  mesh.site_of[vertex] = before;
  return sum;
}

/// Calls look_at(op, vertex, plan) for the planned moves in random meshes.
template <int Dim>
void visit_moves(const SmoothOptions& options, auto&& look_at) {
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    AnyMesh any = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 8 : 4));
    test::jiggle(any, random, 0.4);
    SmoothScene<Dim> scene(executor, any);
    const Smooth<Dim> op(scene.mesh, *scene.background, options);
    for (VertexId v = 0; v < scene.mesh.vertex_slots(); ++v) {
      VertexMove<Dim> plan;
      if (scene.mesh.kind_of[v].class_dimension != 0 && op.decide(v, plan))
        look_at(scene.mesh, op, v, plan);
    }
  }
}

TYPED_TEST(SmoothIn, RaisesTheHarmonicMeanOfQualitiesWhereAllArePoor) {
  constexpr int Dim = TypeParam::value;
  std::size_t moves = 0;
  const SmoothOptions options{.laplacian = false, .optimise_below = 1, .mean_below = 1};
  visit_moves<Dim>(options, [&](auto& mesh, const auto&, VertexId v, const auto& plan) {
    ++moves;
    EXPECT_LT(inverse_qualities(mesh, v, plan.site), inverse_qualities(mesh, v, mesh.site_of[v]));
  });
  EXPECT_GT(moves, 50U);
}

/// The range is in Euclidean lengths, because the metric is the identity.
TYPED_TEST(SmoothIn, LeadsNoEdgeOutOfTheRange) {
  constexpr int Dim = TypeParam::value;
  std::size_t moves = 0;
  const EdgeRange range = Dim == 2 ? EdgeRange{0.1, 0.17} : EdgeRange{0.2, 0.35};
  const SmoothOptions options{.optimise_below = 0.9, .range = range};
  visit_moves<Dim>(options, [&](auto& mesh, const auto&, VertexId v, const auto& plan) {
    ++moves;
    for (const VertexId other : neighbours_of(mesh, v)) {
      const double after = norm(plan.site.position - mesh.site_of[other].position);
      const double before = norm(mesh.site_of[v].position - mesh.site_of[other].position);
      EXPECT_GE(after, std::min(before, range.shortest) - 1e-9);
      EXPECT_LE(after, std::max(before, range.longest) + 1e-9);
    }
  });
  EXPECT_GT(moves, 5U);
}

}  // namespace
}  // namespace ductile::meshadapt::smooth_test
