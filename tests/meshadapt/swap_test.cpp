#include "operators/swap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "ductile/runtime/run_rounds.hpp"
#include "geometry/make_mesh.hpp"
#include "support/meshes.hpp"
#include "support/small_mesh.hpp"

namespace ductile::meshadapt::swap_test {
namespace {

const runtime::Executor executor({.threads = 2});

template <int Dim>
Mesh<Dim> mesh_of(std::initializer_list<Vector<Dim>> points,
                  std::initializer_list<Corners<Dim>> elements) {
  return test::in_unit_metric<Dim>(executor, test::listed_mesh<Dim>(points, elements),
                                   {.complete_boundary = true});
}

template <int Dim>
runtime::UnsetVector<Swappable> improvements(Mesh<Dim>& mesh, std::uint32_t after = 0) {
  return Swap<Dim>::improvements(executor, mesh, after, 0.9);
}

TEST(Swap, FlipsTheLongDiagonalOfAKiteOnce) {
  for (const bool turned : {false, true}) {
    const Corners<2> above{0, 1, 3}, below{0, 2, 1};
    auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -0.4}}, {{0.1, 0.5}}},
                           {turned ? below : above, turned ? above : below});
    const auto found = improvements(mesh);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
    mesh.epoch = 5;
    EXPECT_TRUE(improvements(mesh, 4).empty());
  }
}

TEST(Swap, FlipsFromTheOnlyPoorTriangle) {
  auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -1.6}}, {{0, 0.2}}}, {{0, 1, 3}, {0, 2, 1}});
  EXPECT_EQ(improvements(mesh).size(), 1U);
}

TEST(Swap, LeavesGoodTrianglesAlone) {
  auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -1.7}}, {{0, 1.7}}}, {{0, 1, 3}, {0, 2, 1}});
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, RemovesALongEdgeInsideThreeTetrahedra) {
  auto mesh =
      mesh_of<3>({{{0, 0, -1.2}}, {{0, 0, 1.2}}, {{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}},
                 {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}});
  const auto found = improvements(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
  EXPECT_EQ(found[0].c, none);
}

TEST(Swap, RemovesALongEdgeOfAFlatBoundary) {
  auto mesh = mesh_of<3>({{{-1, 0, 0}}, {{1, 0, 0}}, {{0, -0.6, 0}}, {{0, 0.6, 0}}, {{0, 0, 0.8}}},
                         {{0, 1, 3, 4}, {0, 2, 1, 4}});
  const auto found = improvements(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
  EXPECT_EQ(found[0].c, none);
}

/// Both sides would get the edge 2-3, though they share no facet.
TEST(Swap, MakesNoEdgeThatIsThereOnTheOtherSideOfTheBoundary) {
  auto mesh = mesh_of<3>({{{-1, 0, 0}},
                          {{1, 0, 0}},
                          {{0, -0.6, 0}},
                          {{0, 0.6, 0}},
                          {{0, 0, 0.8}},
                          {{-0.5, 0, -0.8}},
                          {{0.5, 0, -0.8}}},
                         {{0, 1, 3, 4}, {0, 2, 1, 4}, {3, 2, 5, 6}});
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, LeavesTheEdgesOfASingleTetrahedronAlone) {
  auto mesh = mesh_of<3>({{{0, 0, 0}}, {{2, 0, 0}}, {{0, 0.5, 0}}, {{0, 0, 0.5}}}, {{0, 1, 2, 3}});
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, PiercesTheLargeFaceOfFlatTetrahedra) {
  for (const double below : {-0.3, -0.2, -0.9}) {
    auto mesh = mesh_of<3>(
        {{{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}, {{0, 0, 0.25}}, {{0, 0, below}}},
        {{0, 1, 2, 3}, {0, 2, 1, 4}});
    const auto found = improvements(mesh);
    ASSERT_EQ(found.size(), 1U) << below;
    EXPECT_EQ((std::array{found[0].a, found[0].b, found[0].c}), (std::array<VertexId, 3>{0, 1, 2}));
  }
}

TEST(Swap, CutsOffAPoorElementBelowASmoothPatch) {
  auto mesh = test::half_orange(executor, 0.01, 0.03);
  auto found = improvements(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
  Swap<3> swap(executor, mesh);
  EXPECT_EQ(
      runtime::run_rounds_by<runtime::Strategy::reservations>(executor, swap, std::move(found))
          .applied,
      1U);
  std::size_t on_top = 0, elements = 0;
  for (std::size_t e = 0; e < mesh.element_slots(); ++e) {
    if (!mesh.alive(static_cast<ElementId>(e))) continue;
    ++elements;
    EXPECT_FALSE(contains(mesh.corners_of[e], 2) && contains(mesh.corners_of[e], 3));
    on_top += patch_of_edge(mesh, static_cast<ElementId>(e), 0, 1) != 0;
  }
  EXPECT_EQ(elements, 7U);
  EXPECT_EQ(on_top, 2U);
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, CutsNothingOffThatIsFarFromTheInputOrNotPoorOrBelowAnotherRegion) {
  const auto cuts = [](Mesh<3> mesh) {
    auto found = improvements(mesh);
    Swap<3> swap(executor, mesh);
    runtime::run_rounds_by<runtime::Strategy::reservations>(executor, swap, std::move(found));
    return !contains(mesh.corners_of[0], 3);
  };
  EXPECT_TRUE(cuts(test::half_orange(executor, 0.01, 0.03)));
  EXPECT_FALSE(cuts(test::half_orange(executor, 0.01, 0.003)));
  EXPECT_FALSE(cuts(test::half_orange(executor, 0.2, 1)));
  EXPECT_FALSE(cuts(test::half_orange(executor, 0.01, 0.03, true)));
}

}  // namespace
}  // namespace ductile::meshadapt::swap_test
