#include "operators/cut_off.hpp"

#include <gtest/gtest.h>

#include "support/small_mesh.hpp"

namespace ductile::meshadapt::cut_off_test {
namespace {

using test::patch_opposite;

const runtime::Executor executor({.threads = 1});

std::optional<Replacement<3>> planned(const Mesh<3>& mesh) {
  Shell shell;
  shell_of(mesh, 0, 1, shell);
  Ring ring;
  if (!ring.close(shell.size(), 0, 1, [&](std::size_t i) { return mesh.corners_of[shell[i]]; }))
    return {};
  return plan_cut_off(mesh, 0, 1, shell, ring);
}

/// A slice above the edge 0-1, with two facets on a smooth patch, that may be cut off.
Mesh<3> with_flat_slice() { return test::half_orange(executor, 0.01, 0.03); }

TEST(CutOff, TakesASliceAwayAndLeavesItsPatchOnWhatWasBelow) {
  const auto plan = planned(with_flat_slice());
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->old_elements.size(), 3U);
  EXPECT_EQ(plan->new_elements.size(), 2U);
  for (const auto& facet : plan->new_facets) {
    EXPECT_TRUE(contains(facet, 0));
    EXPECT_TRUE(contains(facet, 1));
  }
}

TEST(CutOff, LeavesWhatIsRequired) {
  auto mesh = with_flat_slice();
  EXPECT_NE(patch_above(mesh, 0, 0, 1), 0U);
  mesh.regions[mesh.region_of[0]].required = true;
  EXPECT_EQ(patch_above(mesh, 0, 0, 1), 0U);
  EXPECT_FALSE(planned(mesh));
  mesh = with_flat_slice();
  mesh.patches[patch_opposite(mesh, 0, 0)].required = true;
  EXPECT_FALSE(planned(mesh));
}

TEST(CutOff, LeavesAnElementBetweenTwoPatches) {
  auto mesh = with_flat_slice();
  const PatchId patch = patch_opposite(mesh, 0, 0);
  mesh.patches.push_back(Patch<3>(mesh.patches[patch]));
  patch_opposite(mesh, 0, 1) = static_cast<PatchId>(mesh.patches.size() - 1);
  EXPECT_FALSE(planned(mesh));
}

TEST(CutOff, LeavesCurves) {
  auto mesh = with_flat_slice();
  const auto link = [&](VertexId a, VertexId b) {
    mesh.links_of.insert(a, {b, 1});
    mesh.links_of.insert(b, {a, 1});
  };
  link(0, 1);
  EXPECT_FALSE(planned(mesh));
  mesh = with_flat_slice();
  link(2, 3);
  EXPECT_FALSE(planned(mesh));
}

/// The facet at the edge belongs to a patch that would come to lie on the boundary.
TEST(CutOff, LeavesAnEdgeOfAPatch) {
  auto mesh = with_flat_slice();
  const Corners<3> corners = mesh.corners_of[3];
  for (const VertexId v : corners)
    if (v > 1) {
      patch_opposite(mesh, 3, v) = patch_opposite(mesh, 0, 0);
      break;
    }
  EXPECT_FALSE(planned(mesh));
}

/// Both triangles must be close to the patch; each of them is tested.
TEST(CutOff, ASmoothQuadrilateralStaysCloseOnBothSides) {
  const auto mesh = with_flat_slice();
  const auto close = [&](const std::array<VertexId, 4>& corners, PatchId patch) {
    return convex_in_patch(mesh, corners, patch);
  };
  constexpr VertexId below = 7;
  for (int i = 0; i < 2; ++i) {
    const Facet<3> f = facet_of<3>(mesh.corners_of[0], i);
    const PatchId patch = mesh.patches_of[0][static_cast<std::size_t>(i)];
    ASSERT_NE(patch, 0U);
    const auto at = [&](VertexId v) { return mesh.site_of[v].position; };
    EXPECT_TRUE(
        mesh.surface->facets.cover({at(f[0]), at(f[1]), at(f[2])}, mesh.patches[patch].sheet));
    EXPECT_FALSE(close({below, f[0], f[1], f[2]}, patch));
    EXPECT_FALSE(close({f[0], f[1], below, f[2]}, patch));
  }
}

}  // namespace
}  // namespace ductile::meshadapt::cut_off_test
