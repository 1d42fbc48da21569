#include "operators/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/make_mesh.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::refine_test {
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
  constexpr int n = Dim == 2 ? 12 : 4;
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = test::two_halves(n);
  AnyMesh any = test::make_grid(grid);
  test::jiggle(any, random, 0.3);
  std::vector<std::string> warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, {}, neighbours, warnings);
  for (auto& site : mesh.site_of) {
    std::array<double, Dim> sizes;
    for (double& size : sizes) size = 3.0 / n * std::pow(10.0, test::uniform(random, -1.5, 0.5));
    site = make_site(site.position, test::random_metric<Dim>(random, sizes));
  }
  update_qualities(executor, mesh);
  return mesh;
}

/// Where the metric changes a lot along an edge, the qualities before and after a split are hardly
/// related: overlong edges must not wait for a split of good quality.
TYPED_TEST(RefineIn, SplitsOverlongEdgesIntoWorseQualities) {
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
    const Refine<Dim> hasty(executor, mesh, background, rules);
    const Refine<Dim> patient_one(executor, mesh, background, patient);
    EdgeSurvey<Dim> survey({.shorter = 0, .longer = rules.long_edge});
    for (const LongEdge& edge : long_edges(executor, mesh, survey, rules.long_edge, 0)) {
      const bool splits = hasty.splits(edge);
      const bool patiently_splits = patient_one.splits(edge);
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

using Edge = std::pair<VertexId, VertexId>;

template <int Dim>
std::set<Edge> edges_of(const Mesh<Dim>& mesh) {
  std::set<Edge> edges;
  for (ElementId e = 0; e < mesh.element_slots(); ++e)
    for (const auto& [i, j] : Simplex<Dim>::edge) {
      const VertexId p = mesh.corners_of[e][static_cast<std::size_t>(i)];
      const VertexId q = mesh.corners_of[e][static_cast<std::size_t>(j)];
      edges.emplace(std::min(p, q), std::max(p, q));
    }
  return edges;
}

/// A wild mesh in which the first `most` long edges were split on `threads` threads.
template <int Dim>
struct Refined {
  Mesh<Dim> mesh;
  std::size_t vertices_before;
  runtime::UnsetVector<LongEdge> edges;
  runtime::RoundsReport report;
  std::unique_ptr<Background<Dim>> background;

  bool would_split(const LongEdge& edge) {
    return Refine<Dim>(Executor({.threads = 1}), mesh, *background, Rules{}).splits(edge);
  }

  Refined(std::uint64_t seed, int threads, std::size_t most) {
    const Executor executor({.threads = threads});
    Random random(seed);
    Neighbours<Dim> neighbours;
    mesh = wild_mesh<Dim>(executor, random, neighbours);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
      mesh.host_of[v] = mesh.elements_of.of(v).front();
    background = std::make_unique<Background<Dim>>(executor, mesh, std::move(neighbours));
    vertices_before = mesh.vertex_slots();
    const Rules rules;
    EdgeSurvey<Dim> survey({.shorter = 0, .longer = rules.long_edge});
    edges = long_edges(executor, mesh, survey, rules.long_edge, 0);
    edges.resize(std::min(most, edges.size()));
    Refine<Dim> refinement(executor, mesh, *background, rules);
    report = refinement.run(edges);
    if (refinement.lists_are_stale()) rebuild_elements_of(executor, mesh);
  }
};

TYPED_TEST(RefineIn, RenumberingNeedsNoListsOfNewVertices) {
  constexpr int Dim = TypeParam::value;
  int refined = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Executor executor({.threads = 2});
    Refined<Dim> listed(seed, 2, 100000), unlisted(seed, 2, 100000);
    if (listed.mesh.vertex_slots() == listed.vertices_before) continue;
    ++refined;
    for (auto v = static_cast<VertexId>(unlisted.vertices_before); v < unlisted.mesh.vertex_slots();
         ++v)
      unlisted.mesh.elements_of.clear(v);
    renumber(executor, listed.mesh);
    renumber(executor, unlisted.mesh, static_cast<VertexId>(unlisted.vertices_before));
    EXPECT_EQ(unlisted.mesh.corners_of, listed.mesh.corners_of);
    EXPECT_EQ(unlisted.mesh.vertex_slots(), listed.mesh.vertex_slots());
    const auto faults = check_mesh(executor, unlisted.mesh);
    EXPECT_TRUE(faults.empty()) << test::joined(faults);
  }
  EXPECT_GT(refined, 0);
}

/// Few and many edges, because lists are updated in different ways.
TYPED_TEST(RefineIn, LeavesASoundMesh) {
  constexpr int Dim = TypeParam::value;
  for (const std::size_t most : {1, 5, 100000})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Refined<Dim> refined(seed, 2, most);
      const Mesh<Dim>& mesh = refined.mesh;
      const auto faults = check_mesh(Executor({.threads = 1}), mesh);
      EXPECT_TRUE(faults.empty()) << test::joined(faults);
      EXPECT_EQ(mesh.vertex_slots(), refined.vertices_before + refined.report.applied);
      const std::set<Edge> left = edges_of(mesh);
      std::size_t whole = 0;
      for (const LongEdge& edge : refined.edges) whole += left.count({edge.a, edge.b});
      EXPECT_EQ(whole, refined.edges.size() - refined.report.applied);
      for (ElementId e = 0; e < mesh.element_slots(); ++e)
        EXPECT_EQ(mesh.quality_of[e], static_cast<float>(mesh.quality_at(mesh.corners_of[e])));
    }
}

/// Does an edge connect two sides of a layer, or in 3D of a strip of a patch? Its ends then lie on
/// entities of lower dimension than the entity in which the edge lies.
template <int Dim>
bool is_across(const Mesh<Dim>& mesh, VertexId a, VertexId b) {
  const int ends = std::max(mesh.kind_of[a].class_dimension, mesh.kind_of[b].class_dimension);
  if constexpr (Dim == 3)
    if (mesh.curve_of(a, b) != 0) return false;
  bool on_patch = false;
  Shell shell;
  shell_of(mesh, a, b, shell);
  for (const ElementId e : shell)
    for (std::size_t i = 0; i <= Dim; ++i) {
      const VertexId opposite = mesh.corners_of[e][i];
      on_patch |= mesh.patches_of[e][i] != 0 && opposite != a && opposite != b;
    }
  return ends < (on_patch ? Dim - 1 : Dim);
}

TYPED_TEST(RefineIn, MakesNoShortEdgeExceptAcrossLayers) {
  constexpr int Dim = TypeParam::value;
  std::size_t applied = 0, refused = 0, rounds = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Refined<Dim> refined(seed, 1, 100000);
    rounds = std::max(rounds, refined.report.rounds);
    applied += refined.report.applied;
    refused += refined.report.planned - refined.report.applied;
    for (const auto& [a, b] : edges_of(refined.mesh)) {
      if (b < refined.vertices_before || is_across(refined.mesh, a, b)) continue;
      EXPECT_GE(refined.mesh.length(a, b), Rules{}.shortest_split * (1 - 1e-12));
    }
  }
  EXPECT_GT(applied, 500U);
  EXPECT_GT(refused, 50U);
  EXPECT_GT(rounds, 2U) << "no split was refused because of another one";
}

/// An edge that could be split alone is not left because of another one that is left.
TYPED_TEST(RefineIn, SplitsWhateverMayBeSplitAlone) {
  constexpr int Dim = TypeParam::value;
  std::size_t refused = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Refined<Dim> refined(seed, 2, 100000);
    const std::set<Edge> left = edges_of(refined.mesh);
    for (const LongEdge& edge : refined.edges) {
      if (!left.contains({edge.a, edge.b})) continue;
      ++refused;
      const Shell shell = [&] {
        Shell around;
        shell_of(refined.mesh, edge.a, edge.b, around);
        return around;
      }();
      const bool cut = std::any_of(shell.begin(), shell.end(), [&](ElementId e) {
        const auto& corners = refined.mesh.corners_of[e];
        return std::any_of(corners.begin(), corners.end(),
                           [&](VertexId v) { return v >= refined.vertices_before; });
      });
      EXPECT_FALSE(!cut && refined.would_split(edge));
    }
  }
  EXPECT_GT(refused, 50U);
}

TYPED_TEST(RefineIn, DoesNotDependOnThreads) {
  constexpr int Dim = TypeParam::value;
  for (const std::size_t most : {3, 100000}) {
    const Refined<Dim> one(7, 1, most);
    for (const int threads : test::thread_counts) {
      const Refined<Dim> many(7, threads, most);
      EXPECT_EQ(many.mesh.corners_of, one.mesh.corners_of);
      EXPECT_EQ(many.mesh.patches_of, one.mesh.patches_of);
      EXPECT_EQ(many.mesh.quality_of, one.mesh.quality_of);
      EXPECT_EQ(many.mesh.site_of, one.mesh.site_of);
      EXPECT_EQ(many.mesh.host_of, one.mesh.host_of);
      EXPECT_EQ(many.mesh.kind_of, one.mesh.kind_of);
      EXPECT_EQ(many.mesh.entity_of, one.mesh.entity_of);
      for (VertexId v = 0; v < one.mesh.vertex_slots(); ++v) {
        EXPECT_TRUE(std::ranges::equal(many.mesh.elements_of.of(v), one.mesh.elements_of.of(v)));
        if (Dim == 2) continue;
        EXPECT_TRUE(std::ranges::equal(many.mesh.links_of.of(v), one.mesh.links_of.of(v)));
      }
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt::refine_test
