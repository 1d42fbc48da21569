/// @file
/// Runs the kernels that run_rounds runs under the checks of their contracts, see
/// checked_rounds.hpp.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "checks/check_structure.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/runtime/checked_rounds.hpp"
#include "geometry/make_mesh.hpp"
#include "operators/background.hpp"
#include "operators/coarsen.hpp"
#include "operators/smooth.hpp"
#include "operators/swap.hpp"
#include "operators/swap_by_vertex.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::kernels_checked_test {
namespace {

const runtime::Executor executor({.threads = 2});

/// A small mesh on which every kernel finds something to do.
template <int Dim>
struct Case {
  Mesh<Dim> mesh;
  std::unique_ptr<Background<Dim>> background;

  /// Its boundary is curved, and free to change a little, if the seed is even.
  static Case make(std::uint64_t seed, double complexity) {
    test::Random random(seed);
    test::Grid grid = test::unit_grid(Dim, Dim == 2 ? 10 : 5);
    grid.region = test::two_halves(Dim == 2 ? 10 : 5);
    AnyMesh any = test::make_grid(grid);
    test::jiggle(any, random, 0.3);
    if (seed % 2 == 0) test::bend(any, 1.5);
    AnyField field = test::wild_field(any, random, 1.5, 3);
    test::scale_to(field, any, complexity);
    std::vector<Metric<Dim>> metric_of(any.vertex_count());
    for (std::size_t v = 0; v < metric_of.size(); ++v)
      std::copy_n(&field.values[v * Metric<Dim>::size], Metric<Dim>::size, metric_of[v].m.begin());
    Neighbours<Dim> neighbours;
    std::vector<std::string> warnings;
    auto mesh = make_mesh<Dim>(executor, any, {.hausdorff_tolerance = 0.05}, neighbours, warnings);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      mesh.site_of[v] = make_site(mesh.site_of[v].position, metric_of[v]);
      mesh.host_of[v] = mesh.elements_of.of(v).front();
    }
    update_qualities(executor, mesh);
    auto background = std::make_unique<Background<Dim>>(executor, mesh, std::move(neighbours));
    return {std::move(mesh), std::move(background)};
  }
};

template <class Op, int Dim>
void expect_sound(Mesh<Dim>& mesh, Op&& op,
                  runtime::UnsetVector<typename std::decay_t<Op>::Item> work,
                  runtime::Strategy strategy) {
  try {
    const auto report =
        runtime::run_rounds_checked(executor, op, std::move(work), {.strategy = strategy});
    EXPECT_GT(report.applied, 0U);
  } catch (const runtime::ContractBroken& broken) {
    ADD_FAILURE() << broken.what();
  }
  const auto faults = check_mesh(executor, mesh);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
}

template <class D>
class KernelsChecked : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(KernelsChecked, Dimensions);

TYPED_TEST(KernelsChecked, CoarsenKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = Case<Dim>::make(seed, Dim == 2 ? 20 : 5);
    const Rules rules;
    EdgeSurvey<Dim> survey({.shorter = rules.short_edge, .longer = rules.long_edge});
    expect_sound(mesh, Coarsen<Dim>(mesh, rules),
                 Coarsen<Dim>::short_edge_vertices(executor, mesh, survey, rules.short_edge, 0),
                 runtime::Strategy::tiles);
  }
}

TYPED_TEST(KernelsChecked, SwapKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = Case<Dim>::make(seed, Dim == 2 ? 80 : 60);
    expect_sound(mesh, Swap<Dim>(executor, mesh), Swap<Dim>::improvements(executor, mesh, 0, 1.0),
                 runtime::Strategy::reservations);
  }
}

TYPED_TEST(KernelsChecked, SwapByVertexKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = Case<Dim>::make(seed, Dim == 2 ? 80 : 60);
    SwapByVertex<Dim> op(executor, mesh, Swap<Dim>::improvements(executor, mesh, 0, 1.0));
    expect_sound(mesh, op, op.vertices(), runtime::Strategy::colours);
  }
}

TYPED_TEST(KernelsChecked, SmoothKeepsItsContract) {
  constexpr int Dim = TypeParam::value;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [mesh, background] = Case<Dim>::make(seed, Dim == 2 ? 80 : 60);
    expect_sound(mesh, Smooth<Dim>(mesh, *background, {.optimise_below = 0.6}),
                 Smooth<Dim>::movable_vertices(executor, mesh, 0), runtime::Strategy::tiles);
  }
}

}  // namespace
}  // namespace ductile::meshadapt::kernels_checked_test
