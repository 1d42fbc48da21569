#include "operators/cavity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::cavity_test {
namespace {

TEST(Numbering, CountsInTheOrderOfFirstMeetings) {
  test::Random random(7);
  // As many as are hashed, one less, one more, and many more; some hashes collide.
  for (const std::size_t different : {1, 12, 191, 192, 193, 400}) {
    std::vector<VertexId> known;
    Numbering numbering;
    for (std::size_t i = 0; i < 6 * different; ++i) {
      const auto vertex = static_cast<VertexId>(test::below(random, different) * 977);
      const auto at = std::find(known.begin(), known.end(), vertex);
      const auto number = static_cast<std::size_t>(at - known.begin());
      if (at == known.end()) known.push_back(vertex);
      ASSERT_EQ(numbering.number_of(vertex), number);
      ASSERT_EQ(numbering.size(), known.size());
    }
    const auto all = numbering.vertices();
    EXPECT_EQ(std::vector<VertexId>(all.begin(), all.end()), known);
  }
}

TEST(BeforeDescents, NamesThoseBeforeADescent) {
  std::array<VertexId, 3> facet{3, 5, 8};
  do {
    std::set<VertexId> expected;
    for (std::size_t i = 0; i < 3; ++i)
      if (facet[(i + 1) % 3] > facet[(i + 2) % 3]) expected.insert(facet[i]);
    const auto [one, other] = before_descents(facet);
    EXPECT_EQ((std::set<VertexId>{one, other}), expected);
  } while (std::next_permutation(facet.begin(), facet.end()));
}

template <class Dimension>
class Neighbourhood : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Neighbourhood, Dimensions);

/// Covers vertices on the boundary and on an interface, numbered in any order.
TYPED_TEST(Neighbourhood, IsVisitedWhole) {
  constexpr int Dim = TypeParam::value;
  constexpr int n = Dim == 2 ? 12 : 6;
  test::Random random(11);
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = test::two_halves(n);
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  const runtime::Executor executor({.threads = 1});
  auto mesh = make_mesh<Dim>(executor, test::make_grid(grid), {}, neighbours, warnings);
  std::vector<VertexId> number(mesh.vertex_slots());
  for (std::size_t v = 0; v < number.size(); ++v) number[v] = static_cast<VertexId>(v);
  std::shuffle(number.begin(), number.end(), random);
  const std::vector<VertexKind> kind_of(mesh.kind_of.begin(), mesh.kind_of.end());
  for (std::size_t v = 0; v < number.size(); ++v) mesh.kind_of[number[v]] = kind_of[v];
  for (Corners<Dim>& corners : mesh.corners_of)
    for (VertexId& v : corners) v = number[v];
  rebuild_elements_of(executor, mesh);
  std::vector<std::set<VertexId>> around(mesh.vertex_slots());
  for (const Corners<Dim>& corners : mesh.corners_of)
    for (const VertexId a : corners)
      for (const VertexId b : corners)
        if (a != b) around[a].insert(b);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    std::set<VertexId> visited;
    visit_neighbours(mesh, v, [&](VertexId other) { visited.insert(other); });
    EXPECT_EQ(visited, around[v]);
    const VertexBuffer listed = neighbours_of(mesh, v);
    EXPECT_EQ(std::set<VertexId>(listed.begin(), listed.end()), around[v]);
    EXPECT_EQ(listed.size(), around[v].size());
  }
}

}  // namespace
}  // namespace ductile::meshadapt::cavity_test
