/// @file
/// expect_sound: runs a kernel that run_rounds runs under the checks of its contract, see
/// checked_rounds.hpp.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/runtime/checked_rounds.hpp"
#include "geometry/make_mesh.hpp"
#include "operators/background.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::test {

/// A small mesh on which every kernel finds something to do.
template <int Dim>
struct KernelCase {
  Mesh<Dim> mesh;
  std::unique_ptr<Background<Dim>> background;

  /// Its boundary is curved, and free to change a little, if the seed is even.
  static KernelCase make(const runtime::Executor& executor, std::uint64_t seed, double complexity) {
    Random random(seed);
    Grid grid = unit_grid(Dim, Dim == 2 ? 10 : 5);
    grid.region = two_halves(Dim == 2 ? 10 : 5);
    AnyMesh any = make_grid(grid);
    jiggle(any, random, 0.3);
    if (seed % 2 == 0) bend(any, 1.5);
    AnyField field = wild_field(any, random, 1.5, 3);
    scale_to(field, any, complexity);
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
void expect_sound(const runtime::Executor& executor, Mesh<Dim>& mesh, Op&& op,
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
  EXPECT_TRUE(faults.empty()) << joined(faults);
}

}  // namespace ductile::meshadapt::test
