#include "operators/edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "ductile/meshadapt/make_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt {
namespace {

using runtime::Executor;
using Edge = std::pair<VertexId, VertexId>;

template <class Dimension>
class EdgesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(EdgesIn, Dimensions);

template <int Dim>
std::set<Edge> edges_with_an_end_in(const Mesh<Dim>& mesh,
                                    const std::vector<std::uint8_t>& marked) {
  std::set<Edge> edges;
  for (const Corners<Dim>& corners : mesh.corners_of)
    for (const VertexId a : corners)
      for (const VertexId b : corners)
        if (a < b && (marked[a] || marked[b])) edges.emplace(a, b);
  return edges;
}

/// Regions bring edges on interfaces, which both their triangles know to be on a patch.
TYPED_TEST(EdgesIn, AreFoundOnceFromAnyMarking) {
  constexpr int Dim = TypeParam::value;
  constexpr int n = Dim == 2 ? 12 : 6;
  test::Random random(3);
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = test::two_halves(n);
  const AnyMesh any = test::make_grid(grid);
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const auto mesh = make_mesh<Dim>(Executor({.threads = 1}), any, {}, neighbours, warnings);
  for (const double share : {1.0, 0.3, 0.01, 0.0}) {
    std::vector<std::uint8_t> marked(mesh.vertex_slots());
    for (auto& mark : marked) mark = test::chance(random, share);
    std::vector<Edge> first;
    for (const int threads : {1, 2, 8}) {
      const auto found = collect_edges<Edge>(Executor({.threads = threads}), mesh, {marked},
                                             [](VertexId a, VertexId b, auto&& append) {
                                               append(Edge{a, b});
                                             });
      if (threads == 1) first = found;
      EXPECT_EQ(found, first);
      const std::set<Edge> each(found.begin(), found.end());
      EXPECT_EQ(each.size(), found.size());
      EXPECT_EQ(each, edges_with_an_end_in(mesh, marked));
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

/// What is decided from bounds of lengths is what lengths say.
TYPED_TEST(EdgesIn, AreLongOrShortAsTheirLengthsSay) {
  constexpr int Dim = TypeParam::value;
  const auto mesh = jiggled_grid_in_a_metric<Dim>(6);
  const std::vector<std::uint8_t> all(mesh.vertex_slots(), 1);
  for (const double limit : {0.3, 0.7, 0.9, 1.0, 2.0}) {
    std::set<Edge> longer;
    std::vector<std::uint8_t> ends(mesh.vertex_slots());
    for (const auto& [a, b] : edges_with_an_end_in(mesh, all)) {
      if (mesh.length(a, b) < limit)
        ends[a] = ends[b] = 1;
      else
        longer.emplace(a, b);
    }
    for (const int threads : {1, 2, 8}) {
      const Executor executor({.threads = threads});
      EXPECT_EQ(mark_ends_of_short_edges(executor, mesh, all, limit), ends);
      const auto found = collect_edges<Edge>(executor, mesh, {all, limit},
                                             [](VertexId a, VertexId b, auto&& append) {
                                               append(Edge{a, b});
                                             });
      EXPECT_EQ(found.size(), longer.size());
      EXPECT_EQ(std::set<Edge>(found.begin(), found.end()), longer);
    }
  }
}

}  // namespace
}  // namespace ductile::meshadapt
