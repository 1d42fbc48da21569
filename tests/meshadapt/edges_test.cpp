#include "operators/edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::edges_test {
namespace {

std::vector<std::uint8_t> as_vector(const runtime::UnsetVector<std::uint8_t>& marks) {
  return {marks.begin(), marks.end()};
}

using runtime::Executor;
using Edge = std::pair<VertexId, VertexId>;

template <class Dimension>
class EdgesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(EdgesIn, Dimensions);

/// The edges of elements that changed after an epoch.
template <int Dim>
std::set<Edge> edges_changed(const Mesh<Dim>& mesh, std::uint32_t after) {
  std::set<Edge> edges;
  for (ElementId e = 0; e < mesh.element_slots(); ++e)
    for (const VertexId a : mesh.corners_of[e])
      for (const VertexId b : mesh.corners_of[e])
        if (a < b && mesh.changed_at[e] > after) edges.emplace(a, b);
  return edges;
}

std::set<Edge> ends_of(std::span<const LongEdge> edges) {
  std::set<Edge> ends;
  for (const LongEdge& edge : edges) ends.emplace(edge.a, edge.b);
  EXPECT_EQ(ends.size(), edges.size()) << "some edges were found twice";
  return ends;
}

/// Regions give edges on interfaces, which elements on both sides find on a patch.
TYPED_TEST(EdgesIn, AreFoundOnceNextToAnyChanges) {
  constexpr int Dim = TypeParam::value;
  constexpr int n = Dim == 2 ? 12 : 6;
  test::Random random(3);
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = test::two_halves(n);
  const AnyMesh any = test::make_grid(grid);
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  auto mesh = make_mesh<Dim>(Executor({.threads = 1}), any, {}, neighbours, warnings);
  for (auto& site : mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
  for (const double share : {1.0, 0.3, 0.01, 0.0}) {
    for (std::uint32_t& epoch : mesh.changed_at) epoch = test::chance(random, share) ? 3 : 2;
    runtime::UnsetVector<LongEdge> first;
    for (const int threads : {1, 2, 8}) {
      EdgeSurvey<Dim> survey;
      const auto found = long_edges(Executor({.threads = threads}), mesh, survey, 0, 2);
      if (threads == 1) first = found;
      EXPECT_EQ(found, first);
      EXPECT_EQ(ends_of(found), edges_changed(mesh, 2));
    }
  }
}

template <int Dim>
Mesh<Dim> jiggled_grid_in_a_metric(int n) {
  test::Random random(5);
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  test::jiggle(any, random, 0.3);
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  auto mesh = make_mesh<Dim>(Executor({.threads = 1}), any, {}, neighbours, warnings);
  for (auto& site : mesh.site_of)
    site = make_site(site.position, isotropic<Dim>((1 + site.position[0]) / n));
  return mesh;
}

/// Decisions from bounds on lengths agree with the lengths themselves.
TYPED_TEST(EdgesIn, AreLongOrShortAsTheirLengthsSay) {
  constexpr int Dim = TypeParam::value;
  const auto mesh = jiggled_grid_in_a_metric<Dim>(6);
  test::Random random(9);
  const std::vector<std::uint8_t> all(mesh.vertex_slots(), 1);
  for (const double limit : {0.3, 0.7, 0.9, 1.0, 2.0}) {
    std::set<Edge> longer;
    std::vector<std::uint8_t> ends(mesh.vertex_slots());
    for (const auto& [a, b] : edges_changed(mesh, 0)) {
      if (mesh.length(a, b) < limit)
        ends[a] = ends[b] = 1;
      else
        longer.emplace(a, b);
    }
    for (const int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      EdgeSurvey<Dim> survey({.shorter = limit, .longer = limit});
      EXPECT_EQ(as_vector(mark_ends_of_short_edges(executor, mesh, survey, all, limit)), ends);
      EXPECT_EQ(ends_of(long_edges(executor, mesh, survey, limit, 0)), longer);
      for (const double share : {0.3, 0.01}) {
        std::vector<std::uint8_t> marked(mesh.vertex_slots()), marked_ends(mesh.vertex_slots());
        for (std::size_t v = 0; v < marked.size(); ++v) {
          marked[v] = test::chance(random, share);
          marked_ends[v] = marked[v] & ends[v];
        }
        EdgeSurvey<Dim> fresh({.shorter = 1.1 * limit, .longer = limit});
        EXPECT_EQ(as_vector(mark_ends_of_short_edges(executor, mesh, fresh, marked, limit)),
                  marked_ends);
      }
    }
  }
}

/// Moves a few vertices, and marks the change as a kernel does.
template <int Dim>
void change(Mesh<Dim>& mesh, test::Random& random) {
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    if (!test::chance(random, 0.1)) continue;
    mesh.site_of[v].position[0] += 0.05;
    for (const ElementId e : mesh.elements_of.of(v)) mesh.changed_at[e] = mesh.epoch;
  }
}

/// Edges known from earlier scans are as good as edges measured now.
TYPED_TEST(EdgesIn, AreKnownFromScanToScan) {
  constexpr int Dim = TypeParam::value;
  const typename EdgeSurvey<Dim>::Limits limits{.shorter = 0.9, .longer = 1.1};
  for (const int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    auto mesh = jiggled_grid_in_a_metric<Dim>(6);
    test::Random random(13);
    EdgeSurvey<Dim> survey(limits);
    for (int scan = 0; scan < 10; ++scan) {
      const std::uint32_t after = mesh.epoch - 1;
      change(mesh, random);
      ++mesh.epoch;
      EdgeSurvey<Dim> fresh(limits);
      if (scan % 3 == 2) {
        EXPECT_EQ(long_edges(executor, mesh, survey, limits.longer, after),
                  long_edges(executor, mesh, fresh, limits.longer, after));
      } else {
        const auto marked = mark_changed(executor, mesh, after);
        EXPECT_EQ(
            as_vector(mark_ends_of_short_edges(executor, mesh, survey, marked, limits.shorter)),
            as_vector(mark_ends_of_short_edges(executor, mesh, fresh, marked, limits.shorter)));
      }
    }
  }
}

/// If vertices move without notice, or limits change, edges must be measured again.
TYPED_TEST(EdgesIn, AreMeasuredAnewWhenForgotten) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  auto mesh = jiggled_grid_in_a_metric<Dim>(6);
  ++mesh.epoch;
  EdgeSurvey<Dim> survey({.shorter = 0, .longer = 1000});
  EXPECT_TRUE(long_edges(executor, mesh, survey, 1000, 0).empty());
  survey.compare_with({.shorter = 0, .longer = 1});
  const auto found = ends_of(long_edges(executor, mesh, survey, 1, 0));
  EXPECT_FALSE(found.empty());
  for (auto& site : mesh.site_of) site.position *= 2;
  survey.forget();
  EXPECT_GT(long_edges(executor, mesh, survey, 1, 0).size(), found.size());
}

/// Removes elements, none of them at a curve; their vertices stay.
template <int Dim>
void remove_some(const Executor& executor, Mesh<Dim>& mesh, test::Random& random) {
  for (Corners<Dim>& corners : mesh.corners_of) {
    const bool inside = std::all_of(corners.begin(), corners.end(), [&](VertexId v) {
      return mesh.kind_of[v].class_dimension > 1;
    });
    if (inside && test::chance(random, 0.3)) corners.fill(none);
  }
  rebuild_elements_of(executor, mesh);
}

/// Removed elements have no edges, and elements that take over their numbers have their own.
TYPED_TEST(EdgesIn, AreThoseOfAMeshThatShrinks) {
  constexpr int Dim = TypeParam::value;
  const typename EdgeSurvey<Dim>::Limits limits{.shorter = 0.8, .longer = 0.8};
  for (const int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    auto mesh = jiggled_grid_in_a_metric<Dim>(8);
    test::Random random(17);
    EdgeSurvey<Dim> survey(limits);
    const auto expect_as_if_fresh = [&] {
      ++mesh.epoch;
      EdgeSurvey<Dim> fresh(limits);
      const auto marked = mark_changed(executor, mesh, 0);
      EXPECT_EQ(as_vector(mark_ends_of_short_edges(executor, mesh, survey, marked, limits.shorter)),
                as_vector(mark_ends_of_short_edges(executor, mesh, fresh, marked, limits.shorter)));
      const auto found = long_edges(executor, mesh, survey, limits.longer, 0);
      EXPECT_EQ(found, long_edges(executor, mesh, fresh, limits.longer, 0));
      return found.size();
    };
    const std::size_t at_first = expect_as_if_fresh();
    std::size_t left = at_first;
    for (int step = 0; step < 3; ++step) {
      const std::size_t slots = mesh.element_slots();
      remove_some(executor, mesh, random);
      left = expect_as_if_fresh();
      renumber(executor, mesh);
      survey.forget();
      EXPECT_LT(mesh.element_slots(), slots);
      EXPECT_EQ(expect_as_if_fresh(), left);
    }
    EXPECT_LT(left, at_first);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::edges_test
