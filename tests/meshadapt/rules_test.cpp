/// @file
/// The rules by which operators refuse a change, each tested on a mesh of a few elements: a vertex
/// in the middle of a straight side, or in 3D on a line of the boundary.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "operators/background.hpp"
#include "operators/boundary_shape.hpp"
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

EdgeCollapse collapse(VertexId gone, VertexId kept) {
  EdgeCollapse plan;
  plan.gone = gone;
  plan.kept = kept;
  return plan;
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

/// Vertices of required elements are like corners.
TYPED_TEST(RulesIn, NoCollapseChangesARequiredElement) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = pair_of<Dim>(0.5, 1);
  EdgeCollapse plan;
  auto free = made<Dim>(any);
  EXPECT_TRUE(Coarsen<Dim>(free, {}).decide(1, plan));
  require_first<Dim>(any);
  auto held = made<Dim>(any);
  for (const VertexId v : held.corners_of[0]) {
    EXPECT_EQ(held.kind_of[v].class_dimension, 0);
    EXPECT_FALSE(Coarsen<Dim>(held, {}).decide(v, plan));
  }
}

/// A collapse may exceed the longest allowed edge by 2 % of the longest existing one.
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

/// Along this normal, the facets 0-1 and 0-2 face opposite directions.
TYPED_TEST(RulesIn, ACollapseTurnsNoFacet) {
  constexpr int Dim = TypeParam::value;
  auto mesh = made<Dim>(pair_of<Dim>(0.5, 1));
  mesh.site_of[1].position[1] = -0.2;
  const Coarsen<Dim> op(mesh, {});
  EdgeCollapse plan = collapse(1, 2);
  EXPECT_TRUE(op.keeps_quality(plan, 0.1));
  for (auto& patch : mesh.patches) {
    patch.normal[0] = 1;
    patch.normal[1] = -0.1;
  }
  EXPECT_FALSE(op.keeps_quality(plan, 0.1));
}

TYPED_TEST(RulesIn, OnlyShortEdgesAreCollapsed) {
  constexpr int Dim = TypeParam::value;
  auto mesh = made<Dim>(pair_of<Dim>(0.75, 1.5));
  Rules rules;
  rules.stretched_edge = 2;
  EdgeCollapse plan;
  EXPECT_FALSE(Coarsen<Dim>(mesh, rules).decide(1, plan));
  rules.short_edge = 0.8;
  EXPECT_TRUE(Coarsen<Dim>(mesh, rules).decide(1, plan));
}

TYPED_TEST(RulesIn, TheShortestEdgeIsTriedFirst) {
  constexpr int Dim = TypeParam::value;
  for (const double middle : {0.45, 0.55}) {
    auto mesh = made<Dim>(pair_of<Dim>(middle, 1));
    EdgeCollapse plan;
    ASSERT_TRUE(Coarsen<Dim>(mesh, {}).decide(1, plan));
    EXPECT_EQ(plan.kept, middle < 0.5 ? 0U : 2U);
  }
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
  EXPECT_FALSE(op.keeps_volumes(1, at(0.5, 1.5)));   // its facets keep their orientation
  EXPECT_FALSE(op.keeps_volumes(1, at(1.2, -0.5)));  // its elements have positive volumes
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
  if (Dim == 2) return;
  for (auto& curve : mesh.curves) curve.required = true;
  EXPECT_FALSE(may_split(1, 2));
}

/// The metric is so thin that the volume of a unit element underflows to 0.
TYPED_TEST(RulesIn, NoVertexGetsAMetricWithoutAVolume) {
  constexpr int Dim = TypeParam::value;
  Neighbours<Dim> neighbours;
  auto mesh = made<Dim>(pair_of<Dim>(2, 4), &neighbours);
  Background<Dim> background(executor, mesh, std::move(neighbours));
  const Refine<Dim> op(executor, mesh, background, {});
  EXPECT_TRUE(op.splits({0, 1, 2}));
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    for (int i = 1; i < Dim; ++i) background.log_metric(v).m[Dim == 2 ? 2 : i == 1 ? 2 : 5] = -800;
  EXPECT_FALSE(op.splits({0, 1, 2}));
}

TYPED_TEST(RulesIn, ASplitGivesItsVertexTheReferenceOfBothEnds) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = pair_of<Dim>(2, 4);
  Neighbours<Dim> neighbours;
  auto mesh = made<Dim>(any, &neighbours);
  mesh.reference_of[0] = mesh.reference_of[1] = 5;  // set late: marks no points
  mesh.reference_of[2] = 7;
  const Background<Dim> background(executor, mesh, std::move(neighbours));
  const VertexId first = mesh.vertex_slots();
  Refine<Dim> op(executor, mesh, background, {});
  runtime::UnsetVector<LongEdge> edges;
  edges.push_back({0, 1, 2});
  edges.push_back({1, 2, 2});
  ASSERT_EQ(op.run(std::move(edges)).applied, 2U);
  EXPECT_EQ(mesh.reference_of[first], 5);
  EXPECT_EQ(mesh.reference_of[first + 1], 0);
}

/// Corner 0 of a square with four triangles. Edges from 6, in the middle of the others, would cut
/// it off.
TEST(RulesOfCoarsen, ACornerStaysThoughAnEdgeFromItIsInside) {
  auto mesh = made<2>(test::listed_mesh<2>({{{0, 0}},
                                            {{0.6, 0}},
                                            {{1.2, 0}},
                                            {{1.2, 1.2}},
                                            {{0, 1.2}},
                                            {{0, 0.6}},
                                            {{0.4, 0.4}},
                                            {{0.6, 0.25}},
                                            {{0.25, 0.6}}},
                                           {{0, 1, 7},
                                            {0, 7, 6},
                                            {0, 6, 8},
                                            {0, 8, 5},
                                            {1, 2, 7},
                                            {2, 3, 7},
                                            {7, 3, 6},
                                            {6, 3, 8},
                                            {3, 4, 8},
                                            {8, 4, 5}}));
  const Coarsen<2> op(mesh, {});
  EdgeCollapse plan = collapse(0, 6);
  EXPECT_TRUE(op.keeps_geometry(0, 6));
  EXPECT_TRUE(op.keeps_quality(plan, 0.1));
  EXPECT_FALSE(op.decide(0, plan));
}

using test::patch_opposite;

/// Gives this facet a second patch of its own, which is the side of a crack.
template <int Dim>
void make_crack_side(Mesh<Dim>& mesh, ElementId element, VertexId opposite) {
  PatchId& patch = patch_opposite(mesh, element, opposite);
  mesh.patches.push_back(Patch<Dim>(mesh.patches[patch]));
  mesh.patches.back().crack_side = true;
  patch = static_cast<PatchId>(mesh.patches.size() - 1);
}

/// No edge may connect two rims of a crack's side.
TEST(RulesOfCracks, ASideGetsNoEdgeFromRimToRim) {
  auto mesh = made<2>(pair_of<2>(0.5, 1));
  const Coarsen<2> op(mesh, {});
  EdgeCollapse plan;
  EXPECT_TRUE(op.keeps_sides_apart(collapse(1, 0)));
  EXPECT_TRUE(op.decide(1, plan));
  for (auto& patch : mesh.patches) patch.crack_side = true;
  EXPECT_FALSE(op.keeps_sides_apart(collapse(1, 0)));
  EXPECT_FALSE(op.decide(1, plan));
}

TEST(RulesOfCracks, ACurveOfASideDoesNotBecomeASingleEdge) {
  auto mesh = made<3>(pair_of<3>(0.5, 1));
  const Coarsen<3> op(mesh, {});
  EXPECT_TRUE(op.keeps_sides_apart(collapse(1, 0)));
  make_crack_side(mesh, 0, 4);
  EXPECT_FALSE(op.keeps_sides_apart(collapse(1, 0)));
  mesh.kind_of[2].class_dimension = 1;  // the curve goes on
  EXPECT_TRUE(op.keeps_sides_apart(collapse(1, 0)));
}

TEST(RulesOfCracks, ASideGetsNoTriangleFromRimToRimToRim) {
  auto mesh = made<3>(pair_of<3>(0.5, 1));
  const Coarsen<3> op(mesh, {});
  mesh.kind_of[2].class_dimension = 1;
  EXPECT_TRUE(op.keeps_sides_apart(collapse(1, 0)));
  make_crack_side(mesh, 1, 4);
  EXPECT_FALSE(op.keeps_sides_apart(collapse(1, 0)));
}

/// A tetrahedron whose facet 0-1-2 lies between two edges of one smooth curve.
TEST(RulesOfCurves, TheLastTriangleOfAPatchStays) {
  auto mesh = made<3>(test::listed_mesh<3>(
      {{{0, 0, 0}}, {{0.5, 0.2, 0}}, {{1, 0, 0}}, {{0.5, 0.1, 0.5}}}, {{0, 1, 2, 3}}));
  const CurveId curve = mesh.links_of.of(1)[0].curve;
  mesh.curves[curve].smooth = true;
  mesh.kind_of[1].class_dimension = 1;
  mesh.entity_of[1] = curve;
  mesh.links_of.clear(1);
  for (const VertexId end : {0U, 2U}) mesh.links_of.insert(1, {end, curve});
  patch_opposite(mesh, 0, 0) = 0;
  const Coarsen<3> op(mesh, {});
  EXPECT_FALSE(op.keeps_geometry(1, 0));
  patch_opposite(mesh, 0, 3) = 0;
  EXPECT_TRUE(op.keeps_geometry(1, 0));
}

/// The upper end of a pyramid with twelve sides, and a listed circle of twelve edges on it.
Mesh<3> circle_on_a_plane(double tolerance, Neighbours<3>* neighbours = nullptr) {
  constexpr std::uint32_t sides = 12;
  AnyMesh any;
  any.dimension = 3;
  any.coordinates = {0, 0, 0, 0, 0, -1};
  for (const double radius : {1.0, 2.0})
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      any.coordinates.insert(any.coordinates.end(),
                             {radius * std::cos(angle), radius * std::sin(angle), 0});
    }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % sides;
    any.tetrahedra.add({0, b, a, 1}, 1);
    any.tetrahedra.add({a, b, a + sides, 1}, 1);
    any.tetrahedra.add({b, b + sides, a + sides, 1}, 1);
    any.edges.add({a, b}, 3);
    any.ridges.push_back(i);
  }
  any.vertex_reference.assign(any.coordinates.size() / 3, 0);
  return test::in_unit_metric<3>(
      executor, any, {.complete_boundary = true, .hausdorff_tolerance = tolerance}, neighbours);
}

/// All facets lie in one plane, so that only the curve limits the change.
TEST(RulesOfCurves, ASmoothCurveStaysCloseToTheInput) {
  for (const bool coarse : {false, true}) {
    Neighbours<3> neighbours;
    auto mesh = circle_on_a_plane(coarse ? 0.5 : 0.01, &neighbours);
    ASSERT_TRUE(on_smooth_curve(mesh, 2));
    EXPECT_EQ(Coarsen<3>(mesh, {}).keeps_surface(collapse(2, 3)), coarse);
    const Background<3> background(executor, mesh, std::move(neighbours));
    const Smooth<3> op(mesh, background, {});
    const auto keeps_at = [&](double angle) {
      return op.keeps_surface(2, {{std::cos(angle), std::sin(angle), 0}});
    };
    EXPECT_EQ(keeps_at(0.25), coarse);
    EXPECT_FALSE(keeps_at(0.5));
  }
}

/// The corners of a square, the middle of one side, and two interior vertices, 5 and 6, side by
/// side.
Mesh<2> square_with_two_inside() {
  return made<2>(test::listed_mesh<2>(
      {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{0, 0.45}}, {{0.3, 0.4}}, {{0.5, 0.45}}},
      {{0, 1, 5}, {1, 6, 5}, {1, 2, 6}, {2, 3, 6}, {3, 5, 6}, {3, 4, 5}, {4, 0, 5}}));
}

/// Only neighbours of the kept vertex that may be removed are noted.
TEST(RulesOfCoarsen, VerticesThatGetAShortEdgeAreNoted) {
  auto mesh = square_with_two_inside();
  EdgeCollapse plan;
  ASSERT_TRUE(Coarsen<2>(mesh, {}).decide(5, plan));
  EXPECT_EQ(plan.kept, 6U);
  EXPECT_EQ(std::vector(plan.short_edge_vertices.begin(), plan.short_edge_vertices.end()),
            std::vector<VertexId>{4});
}

/// The rule also holds if the interface between the regions is not listed.
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
    for (auto& patches : flat.patches_of) patches[3] = 0;  // the face 0-1-2
    Replacement<3> pierced;
    EXPECT_EQ(Swap<3>(executor, flat).decide({0, 1, 2}, Shell{0, 1}, pierced), second == 1);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::rules_test
