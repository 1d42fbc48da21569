/// @file
/// Runs the kernels of run_rounds under the checks of checked_rounds.hpp.
#include <gtest/gtest.h>

#include "operators/coarsen.hpp"
#include "operators/smooth.hpp"
#include "operators/swap.hpp"
#include "operators/swap_by_vertex.hpp"
#include "support/checked_kernel.hpp"

namespace ductile::meshadapt::kernels_checked_test {
namespace {

const runtime::Executor executor({.threads = 2});

template <class D>
class KernelsChecked : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(KernelsChecked, Dimensions);

TYPED_TEST(KernelsChecked, CoarsenKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = test::KernelCase<Dim>::make(executor, seed, Dim == 2 ? 20 : 5);
    const Rules rules;
    EdgeSurvey<Dim> survey({.shorter = rules.short_edge, .longer = rules.long_edge});
    test::expect_sound(
        executor, mesh, Coarsen<Dim>(mesh, rules),
        Coarsen<Dim>::short_edge_vertices(executor, mesh, survey, rules.short_edge, 0),
        runtime::Strategy::tiles);
  }
}

TYPED_TEST(KernelsChecked, SwapKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = test::KernelCase<Dim>::make(executor, seed, Dim == 2 ? 80 : 60);
    test::expect_sound(executor, mesh, Swap<Dim>(executor, mesh),
                       Swap<Dim>::improvements(executor, mesh, 0, 1.0),
                       runtime::Strategy::reservations);
  }
}

TYPED_TEST(KernelsChecked, SwapByVertexKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = test::KernelCase<Dim>::make(executor, seed, Dim == 2 ? 80 : 60);
    SwapByVertex<Dim> op(executor, mesh, Swap<Dim>::improvements(executor, mesh, 0, 1.0));
    test::expect_sound(executor, mesh, op, op.vertices(), runtime::Strategy::colours);
  }
}

TYPED_TEST(KernelsChecked, SmoothKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = test::KernelCase<Dim>::make(executor, seed, Dim == 2 ? 80 : 60);
    test::expect_sound(executor, mesh, Smooth<Dim>(mesh, *background, {.optimise_below = 0.6}),
                       Smooth<Dim>::movable_vertices(executor, mesh, 0), runtime::Strategy::tiles);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::kernels_checked_test
