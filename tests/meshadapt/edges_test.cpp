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
      const auto found = collect_edges<Edge>(Executor({.threads = threads}), mesh, marked,
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

}  // namespace
}  // namespace ductile::meshadapt
