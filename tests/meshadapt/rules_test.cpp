/// @file
/// The rules by which operators refuse a change, each asked on a mesh of a few elements: a vertex
/// in the middle of a straight side, on a line of the boundary in 3D.
#include <gtest/gtest.h>

#include <memory>

#include "operators/background.hpp"
#include "operators/coarsen.hpp"
#include "operators/edges.hpp"
#include "operators/refine.hpp"
#include "operators/smooth.hpp"
#include "operators/swap.hpp"
#include "support/small_mesh.hpp"

namespace ductile::meshadapt::rules_test {
namespace {

const runtime::Executor executor({.threads = 1});

/// Elements 0-1-3 and 1-2-3, in 3D with 4 as well; 1 lies between 0 and 2.
template <int Dim>
AnyMesh pair_of(double middle, double end, std::vector<std::int32_t> references = {}) {
  if constexpr (Dim == 2)
    return test::listed_mesh<2>({{{0, 0}}, {{middle, 0}}, {{end, 0}}, {{end / 2, 0.8}}},
                                {{0, 1, 3}, {1, 2, 3}}, std::move(references));
  else
    return test::listed_mesh<3>(
        {{{0, 0, 0}}, {{middle, 0, 0}}, {{end, 0, 0}}, {{end / 2, 0.8, 0}}, {{end / 2, 0, 0.8}}},
        {{0, 1, 3, 4}, {1, 2, 3, 4}}, std::move(references));
}

template <int Dim>
Mesh<Dim> made(const AnyMesh& any, Neighbours<Dim>* neighbours = nullptr) {
  return test::in_unit_metric<Dim>(executor, any, {.complete_boundary = true}, neighbours);
}

template <int Dim>
void require_first(AnyMesh& any) {
  (Dim == 2 ? any.required_triangles : any.required_tetrahedra) = {0};
}

template <class D>
class RulesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RulesIn, Dimensions);

TYPED_TEST(RulesIn, AVertexOfTheBoundaryIsCollapsedAlongItOnly) {
  constexpr int Dim = TypeParam::value;
  auto mesh = made<Dim>(pair_of<Dim>(0.5, 1));
  ASSERT_EQ(mesh.kind_of[1].class_dimension, 1);
  const Coarsen<Dim> op(mesh, {});
  EXPECT_TRUE(op.keeps_geometry(1, 0));
  EXPECT_TRUE(op.keeps_geometry(1, 2));
  EXPECT_FALSE(op.keeps_geometry(1, 3));
}

TYPED_TEST(RulesIn, NoCollapseChangesARequiredElement) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = pair_of<Dim>(0.5, 1);
  EdgeCollapse plan;
  auto free = made<Dim>(any);
  EXPECT_TRUE(Coarsen<Dim>(free, {}).keeps_required(1));
  EXPECT_TRUE(Coarsen<Dim>(free, {}).decide(1, plan));
  require_first<Dim>(any);
  auto held = made<Dim>(any);
  const Coarsen<Dim> op(held, {});
  EXPECT_FALSE(op.keeps_required(0));
  EXPECT_FALSE(op.keeps_required(1));
  EXPECT_FALSE(op.decide(1, plan));
  EXPECT_TRUE(op.keeps_required(2));
}

/// A collapse may make an edge longer than the rules want by 2 % of the longest that is there.
TYPED_TEST(RulesIn, LongEdgesAreExtendedALittleOrNotAtAll) {
  constexpr int Dim = TypeParam::value;
  EdgeCollapse plan;
  Rules strict;
  strict.extends_long_edges = false;
  auto little = made<Dim>(pair_of<Dim>(0.02, 1.52)), much = made<Dim>(pair_of<Dim>(0.1, 1.6));
  EXPECT_TRUE(Coarsen<Dim>(little, {}).decide(1, plan));
  EXPECT_FALSE(Coarsen<Dim>(little, strict).decide(1, plan));
  EXPECT_FALSE(Coarsen<Dim>(much, {}).decide(1, plan));
}

TYPED_TEST(RulesIn, AMoveLeavesVolumesPositiveAndLengthsInTheirRange) {
  constexpr int Dim = TypeParam::value;
  Neighbours<Dim> neighbours;
  auto mesh = made<Dim>(pair_of<Dim>(0.5, 1), &neighbours);
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  const Smooth<Dim> op(mesh, background, {.range = {0.2, 0.9}});
  const auto at = [](double x, double y) {
    Vector<Dim> place{};
    place.x[0] = x;
    place.x[1] = y;
    return place;
  };
  const auto site_at = [&](double x) { return make_site(at(x, 0), mesh.site_of[1].metric); };
  EXPECT_TRUE(op.keeps_volumes(1, at(0.9, 0)));
  EXPECT_FALSE(op.keeps_volumes(1, at(1, 0)));    // flat
  EXPECT_FALSE(op.keeps_volumes(1, at(1.1, 0)));  // inverted
  EXPECT_FALSE(op.keeps_volumes(1, at(-0.1, 0)));
  EXPECT_TRUE(op.keeps_lengths(1, site_at(0.7)));
  EXPECT_FALSE(op.keeps_lengths(1, site_at(0.9)));  // too close to 2
}

TYPED_TEST(RulesIn, NoEdgeOfARequiredElementIsSplit) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = pair_of<Dim>(0.5, 1);
  require_first<Dim>(any);
  Neighbours<Dim> neighbours;
  auto mesh = made<Dim>(any, &neighbours);
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  const Refine<Dim> op(executor, mesh, background, {});
  const auto may_split = [&](VertexId a, VertexId b) {
    Shell shell;
    shell_of(mesh, a, b, shell);
    return op.may_split({a, b, 2}, shell);
  };
  EXPECT_FALSE(may_split(0, 1));
  EXPECT_FALSE(may_split(1, 3));
  EXPECT_TRUE(may_split(1, 2));
}

/// Even where the interface between them is not known as one.
TEST(RulesOfSwap, NoEdgeOrFaceBetweenRegionsIsSwapped) {
  for (const std::int32_t second : {1, 2}) {
    auto kite = made<2>(test::listed_mesh<2>({{{-1, 0}}, {{1, 0}}, {{0, -0.4}}, {{0.1, 0.5}}},
                                             {{0, 1, 3}, {0, 2, 1}}, {1, second}));
    for (auto& patches : kite.patches_of)
      for (std::size_t i = 0; i < 3; ++i)
        if (neighbour(kite, static_cast<ElementId>(&patches - &kite.patches_of[0]),
                      static_cast<int>(i)) != none)
          patches[i] = 0;
    Replacement<2> flip;
    EXPECT_EQ(Swap<2>(executor, kite).decide({0, 1}, Shell{0, 1}, flip), second == 1);
    auto flat = made<3>(test::listed_mesh<3>(
        {{{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}, {{0, 0, 0.3}}, {{0, 0, -0.3}}},
        {{0, 1, 2, 3}, {0, 2, 1, 4}}, {1, second}));
    for (auto& patches : flat.patches_of) patches[3] = 0;  // of the face 0-1-2
    Replacement<3> pierced;
    EXPECT_EQ(Swap<3>(executor, flat).decide({0, 1, 2}, Shell{0, 1}, pierced), second == 1);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::rules_test
