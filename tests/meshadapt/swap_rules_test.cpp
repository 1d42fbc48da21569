/// @file
/// The rules by which swaps are refused, each tested on a mesh of a few elements that is changed so
/// that no other rule refuses.
#include <gtest/gtest.h>

#include "operators/swap.hpp"
#include "support/small_mesh.hpp"

namespace ductile::meshadapt::swap_rules_test {
namespace {

using test::patch_opposite;

const runtime::Executor executor({.threads = 1});

template <int Dim>
Mesh<Dim> made(const AnyMesh& any) {
  return test::in_unit_metric<Dim>(executor, any, {.complete_boundary = true});
}

/// Two triangles whose edge 0-1 should be flipped.
AnyMesh kite() {
  return test::listed_mesh<2>({{{-1, 0}}, {{1, 0}}, {{0, -0.4}}, {{0.1, 0.5}}},
                              {{0, 1, 3}, {0, 2, 1}});
}

/// Three tetrahedra around an edge 0-1 that should be removed.
AnyMesh three_around_an_edge() {
  return test::listed_mesh<3>(
      {{{0, 0, -1.2}}, {{0, 0, 1.2}}, {{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}},
      {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}});
}

/// Two tetrahedra at an edge 0-1 of a flat side that should be removed.
AnyMesh two_at_a_side() {
  return test::listed_mesh<3>(
      {{{-1, 0, 0}}, {{1, 0, 0}}, {{0, -0.6, 0}}, {{0, 0.6, 0}}, {{0, 0, 0.8}}},
      {{0, 1, 3, 4}, {0, 2, 1, 4}});
}

/// Two tetrahedra whose face 0-1-2 should be replaced by an edge.
AnyMesh two_at_a_face() {
  return test::listed_mesh<3>(
      {{{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}, {{0, 0, 0.3}}, {{0, 0, -0.3}}},
      {{0, 1, 2, 3}, {0, 2, 1, 4}});
}

/// Would the edge 0-1 be swapped?
template <int Dim>
bool swaps_edge(Mesh<Dim>& mesh, const EdgeRange& range = {}) {
  Shell shell;
  shell_of(mesh, 0, 1, shell);
  Replacement<Dim> plan;
  return Swap<Dim>(executor, mesh, range).decide({0, 1}, shell, plan);
}

bool pierces_face(Mesh<3>& mesh, const EdgeRange& range = {}) {
  Replacement<3> plan;
  return Swap<3>(executor, mesh, range).decide({0, 1, 2}, Shell{0, 1}, plan);
}

/// Moves this element to a new region.
template <int Dim>
void give_own_region(Mesh<Dim>& mesh, ElementId element) {
  mesh.region_of[element] = static_cast<std::uint32_t>(mesh.regions.size());
  mesh.regions.push_back(Region(mesh.regions[0]));
}

/// Adds a copy of this patch.
template <int Dim>
PatchId copy_of_patch(Mesh<Dim>& mesh, PatchId patch) {
  mesh.patches.push_back(Patch<Dim>(mesh.patches[patch]));
  return static_cast<PatchId>(mesh.patches.size() - 1);
}

TEST(RulesOfFlips, RequiredTrianglesStay) {
  AnyMesh any = kite();
  auto free = made<2>(any);
  EXPECT_TRUE(swaps_edge(free));
  any.required_triangles = {0, 1};
  auto held = made<2>(any);
  EXPECT_FALSE(swaps_edge(held));
}

TEST(RulesOfFlips, AnEdgeOfAPatchStays) {
  auto mesh = made<2>(kite());
  patch_opposite(mesh, 0, 3) = patch_opposite(mesh, 1, 2) = 1;
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfFlips, ANewEdgeIsInTheRange) {
  auto mesh = made<2>(kite());
  EXPECT_TRUE(swaps_edge(mesh, {.shortest = 0.8, .longest = 3}));
  EXPECT_FALSE(swaps_edge(mesh, {.shortest = 1, .longest = 3}));
}

TEST(RulesOfEdgeRemoval, AnEdgeOfACurveStays) {
  auto mesh = made<3>(three_around_an_edge());
  EXPECT_TRUE(swaps_edge(mesh));
  mesh.links_of.insert(0, {1, 1});
  mesh.links_of.insert(1, {0, 1});
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfEdgeRemoval, AnEdgeBetweenRegionsStays) {
  auto mesh = made<3>(three_around_an_edge());
  give_own_region(mesh, 1);
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfEdgeRemoval, RequiredElementsAndFacetsStay) {
  AnyMesh any = three_around_an_edge();
  any.required_tetrahedra = {0, 1, 2};
  auto held = made<3>(any);
  EXPECT_FALSE(swaps_edge(held));
  auto side = made<3>(two_at_a_side());
  EXPECT_TRUE(swaps_edge(side));
  side.patches[patch_opposite(side, 0, 4)].required = true;
  EXPECT_FALSE(swaps_edge(side));
}

TEST(RulesOfEdgeRemoval, AnEdgeBetweenPatchesStays) {
  auto mesh = made<3>(two_at_a_side());
  patch_opposite(mesh, 0, 4) = copy_of_patch(mesh, patch_opposite(mesh, 0, 4));
  EXPECT_FALSE(swaps_edge(mesh));
}

/// A sheet of facets ends at a side with the same patch.
TEST(RulesOfEdgeRemoval, AnEdgeOfMoreThanTwoFacetsStays) {
  auto mesh = made<3>(two_at_a_side());
  patch_opposite(mesh, 0, 3) = patch_opposite(mesh, 1, 2) = patch_opposite(mesh, 0, 4);
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfEdgeRemoval, AnEdgeOfASheetInsideStays) {
  auto mesh = made<3>(three_around_an_edge());
  patch_opposite(mesh, 0, 3) = patch_opposite(mesh, 2, 4) = 1;
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfEdgeRemoval, ACrackSideGetsNoEdgeFromRimToRim) {
  auto mesh = made<3>(two_at_a_side());
  mesh.patches[patch_opposite(mesh, 0, 4)].crack_side = true;
  EXPECT_FALSE(swaps_edge(mesh));
  mesh.kind_of[3].class_dimension = 2;
  EXPECT_TRUE(swaps_edge(mesh));
}

/// Projected along this normal, the side is a line.
TEST(RulesOfEdgeRemoval, APatchIsNotFolded) {
  auto mesh = made<3>(two_at_a_side());
  mesh.patches[patch_opposite(mesh, 0, 4)].normal = {{1, 0, 0}};
  EXPECT_FALSE(swaps_edge(mesh));
}

TEST(RulesOfPiercing, FacesOfRequiredElementsStay) {
  AnyMesh any = two_at_a_face();
  auto free = made<3>(any);
  EXPECT_TRUE(pierces_face(free));
  any.required_tetrahedra = {0, 1};
  auto held = made<3>(any);
  EXPECT_FALSE(pierces_face(held));
}

TEST(RulesOfPiercing, AFaceOfAPatchStays) {
  auto mesh = made<3>(two_at_a_face());
  patch_opposite(mesh, 0, 3) = patch_opposite(mesh, 1, 4) = 1;
  EXPECT_FALSE(pierces_face(mesh));
}

TEST(RulesOfPiercing, TheNewEdgeIsInTheRange) {
  auto mesh = made<3>(two_at_a_face());
  EXPECT_TRUE(pierces_face(mesh, {.shortest = 0.5, .longest = 3}));
  EXPECT_FALSE(pierces_face(mesh, {.shortest = 0.7, .longest = 3}));
}

}  // namespace
}  // namespace ductile::meshadapt::swap_rules_test
