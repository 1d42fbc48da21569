#include "operators/coarsen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/runtime/run_rounds.hpp"
#include "support/check_structure.hpp"
#include "support/checked_kernel.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::coarsen_test {
namespace {

using runtime::Executor;

template <class Dimension>
class CoarsenIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CoarsenIn, Dimensions);

/// A random mesh, with curved boundaries for half of the seeds, coarsened until no rule allows a
/// collapse.
template <int Dim>
struct Coarsened {
  Mesh<Dim> mesh;
  std::size_t vertices_before = 0, applied = 0;

  Coarsened(std::uint64_t seed, int threads, const Rules& rules,
            runtime::Strategy strategy = runtime::Strategy::tiles) {
    const Executor executor({.threads = threads});
    auto made = test::KernelCase<Dim>::make(executor, seed, Dim == 2 ? 20 : 5);
    mesh = std::move(made.mesh);
    vertices_before = vertices_in_use();
    for (int sweep = 0; sweep < 3; ++sweep) {
      EdgeSurvey<Dim> survey({.shorter = rules.short_edge, .longer = rules.long_edge});
      const auto vertices =
          Coarsen<Dim>::short_edge_vertices(executor, mesh, survey, rules.short_edge, 0);
      Coarsen<Dim> op(mesh, rules);
      if (strategy == runtime::Strategy::colours) op.defer_lists(executor);
      applied += runtime::run_rounds(executor, op, vertices, {.strategy = strategy}).applied;
    }
  }
  std::size_t vertices_in_use() const {
    std::size_t count = 0;
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) count += mesh.vertex_alive(v);
    return count;
  }
};

TYPED_TEST(CoarsenIn, LeavesASoundMeshWithoutTheVerticesThatWent) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Coarsened<Dim> coarsened(seed, 2, {});
    const auto faults = check_mesh(Executor({.threads = 1}), coarsened.mesh);
    EXPECT_TRUE(faults.empty()) << seed << ": " << test::joined(faults);
    EXPECT_GT(coarsened.applied, 0U);
    EXPECT_EQ(coarsened.vertices_in_use(), coarsened.vertices_before - coarsened.applied);
  }
}

TYPED_TEST(CoarsenIn, MovesNoVertexAndTakesNoCorner) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto before =
        test::KernelCase<Dim>::make(Executor({.threads = 1}), seed, Dim == 2 ? 20 : 5);
    const Coarsened<Dim> after(seed, 2, {});
    for (VertexId v = 0; v < before.mesh.vertex_slots(); ++v) {
      const bool alive = after.mesh.vertex_alive(v);
      EXPECT_TRUE(alive || before.mesh.kind_of[v].class_dimension != 0);
      EXPECT_TRUE(!alive || after.mesh.site_of[v] == before.mesh.site_of[v]);
    }
  }
}

/// With strict rules, new edges are not longer and new elements not worse than the rules allow.
TYPED_TEST(CoarsenIn, MakesNoLongEdgesAndNoPoorElements) {
  constexpr int Dim = TypeParam::value;
  Rules strict;
  strict.extends_long_edges = false;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto before =
        test::KernelCase<Dim>::make(Executor({.threads = 1}), seed, Dim == 2 ? 20 : 5);
    double worst = strict.accepted_quality;
    for (ElementId e = 0; e < before.mesh.element_slots(); ++e)
      worst = std::min<double>(worst, before.mesh.quality_of[e]);
    const Coarsened<Dim> after(seed, 2, strict);
    for (ElementId e = 0; e < after.mesh.element_slots(); ++e) {
      if (!after.mesh.alive(e)) continue;
      EXPECT_GE(after.mesh.quality_of[e], worst * (1 - 1e-6));
      if (after.mesh.corners_of[e] == before.mesh.corners_of[e]) continue;
      for (const VertexId v : after.mesh.corners_of[e]) {
        if (contains(before.mesh.corners_of[e], v)) continue;
        for (const VertexId other : after.mesh.corners_of[e])  // v replaced a removed vertex
          EXPECT_TRUE(other == v || !contains(before.mesh.corners_of[e], other) ||
                      after.mesh.length(v, other) <= strict.stretched_edge * (1 + 1e-9));
      }
    }
  }
}

TYPED_TEST(CoarsenIn, DoesNotDependOnThreads) {
  if (test::address_sanitized) GTEST_SKIP() << test::compares_threads;
  constexpr int Dim = TypeParam::value;
  for (const auto strategy : {runtime::Strategy::tiles, runtime::Strategy::colours})
    for (const std::uint64_t seed : {3U, 4U}) {
      const Coarsened<Dim> one(seed, 1, {}, strategy);
      for (const int threads : test::thread_counts) {
        const Coarsened<Dim> many(seed, threads, {}, strategy);
        EXPECT_EQ(many.mesh.corners_of, one.mesh.corners_of) << threads;
        EXPECT_EQ(many.mesh.patches_of, one.mesh.patches_of);
        EXPECT_EQ(many.mesh.quality_of, one.mesh.quality_of);
        EXPECT_EQ(many.applied, one.applied);
      }
    }
}

}  // namespace
}  // namespace ductile::meshadapt::coarsen_test
