#include "mesh/adjacency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <type_traits>
#include <vector>

#include "support/meshes.hpp"

namespace ductile::meshadapt::adjacency_test {
namespace {

using runtime::Executor;

/// A mesh whose elements are in random order, so that the elements of a list are far apart.
template <int Dim>
AnyMesh shuffled() {
  AnyMesh mesh = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 60 : 12));
  std::mt19937 random(3);
  std::ranges::shuffle(Dim == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference, random);
  if constexpr (Dim == 2)
    std::ranges::shuffle(mesh.triangles.vertices, random);
  else
    std::ranges::shuffle(mesh.tetrahedra.vertices, random);
  return mesh;
}

using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
template <class Dimension>
class AdjacencyTest : public testing::Test {};
TYPED_TEST_SUITE(AdjacencyTest, Dimensions);

TYPED_TEST(AdjacencyTest, SaysWhatAllElementsHaveInCommon) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh mesh = shuffled<Dim>();
  const AdjacentMesh adjacent(executor, mesh);
  const auto& adjacency = adjacent.adjacency<Dim>();
  const auto& elements = elements_in<Dim>(mesh).vertices;
  std::size_t outside = 0;
  for (ElementId e = 0; e < elements.size(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const Facet<Dim> corners = facet_of<Dim>(elements[e], i);
      std::vector<ElementId> have;
      for (const ElementId f : adjacency.elements_of(corners[0]))
        if (has_facet<Dim>(elements[f], corners)) have.push_back(f);
      ASSERT_TRUE(std::ranges::count(have, e) == 1 && std::ranges::is_sorted(have));
      ASSERT_LE(have.size(), 2U);
      const ElementId other = have.size() == 1 ? none : have[0] == e ? have[1] : have[0];
      ASSERT_EQ(adjacency.across(e, i), other);
      ASSERT_EQ(adjacency.find(corners).element, have[0]);
      ASSERT_EQ(adjacency.is_first({e, i}), have[0] == e);
      ASSERT_EQ(adjacency.on_region_boundary(e, i, {}), other == none);
      const ElementFacet there = adjacency.other_side({e, i});
      ASSERT_EQ(there.element, other);
      if (other != none) {
        ASSERT_EQ(adjacency.across(other, there.facet), e);
      }
      outside += other == none;
    }
  EXPECT_EQ(outside, facets_in<Dim>(mesh).size());
}

TYPED_TEST(AdjacencyTest, IsTheSameOnAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh mesh = shuffled<Dim>();
  const Executor one({.threads = 1});
  const AdjacentMesh expected(one, mesh);
  const auto& by_one = expected.adjacency<Dim>();
  for (const int threads : {2, 3, 8}) {
    const Executor executor({.threads = threads});
    const AdjacentMesh adjacent(executor, mesh);
    EXPECT_EQ(adjacent.lists<Dim>().around, by_one.around);
    EXPECT_EQ(adjacent.adjacency<Dim>().first_around, by_one.first_around);
    EXPECT_EQ(adjacent.adjacency<Dim>().neighbour_of, by_one.neighbour_of);
  }
}

/// Three triangles share an edge; the second and the third belong to one region.
TEST(Adjacency, KnowsWhereThreeElementsMeet) {
  AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 0, 1, 0, -1, 1, 1};
  mesh.vertex_reference.assign(5, 0);
  mesh.triangles.add({0, 1, 2}, 1);
  mesh.triangles.add({1, 0, 3}, 2);
  mesh.triangles.add({0, 1, 4}, 2);
  const Executor executor({.threads = 1});
  const AdjacentMesh adjacent(executor, mesh);
  const auto& adjacency = adjacent.adjacency<2>();
  const std::vector<std::uint32_t> region_of{1, 2, 2};
  for (ElementId e = 0; e < 3; ++e) {
    EXPECT_EQ(adjacency.across(e, 2), crowded);
    EXPECT_EQ(adjacency.is_first({e, 2}), e == 0);
    EXPECT_EQ(adjacency.other_side({e, 2}).element, none);
    EXPECT_FALSE(adjacency.on_region_boundary(e, 2, {}));
    EXPECT_EQ(adjacency.on_region_boundary(e, 2, region_of), e == 0);
  }
}

/// Two triangles share all edges, a third has one of these; the other two edges keep their pair.
TEST(Adjacency, IsCrowdedOnlyWhereThreeElementsMeet) {
  AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 0, 1, 1, 1};
  mesh.vertex_reference.assign(4, 0);
  mesh.triangles.add({0, 1, 2}, 1);
  mesh.triangles.add({1, 0, 2}, 1);
  mesh.triangles.add({0, 1, 3}, 1);
  const Executor executor({.threads = 1});
  const AdjacentMesh adjacent(executor, mesh);
  const auto& adjacency = adjacent.adjacency<2>();
  for (ElementId e = 0; e < 2; ++e)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(adjacency.across(e, i), i == 2 ? crowded : 1 - e);
}

TEST(Adjacency, FindsNoFacetWhereThereIsNone) {
  const AnyMesh mesh = test::make_grid(test::unit_grid(3, 2));
  const Executor executor({.threads = 1});
  const AdjacentMesh adjacent(executor, mesh);
  const auto last = static_cast<VertexId>(mesh.vertex_count() - 1);
  EXPECT_EQ(adjacent.adjacency<3>().find({0, 1, last}).element, none);
}

}  // namespace
}  // namespace ductile::meshadapt::adjacency_test
