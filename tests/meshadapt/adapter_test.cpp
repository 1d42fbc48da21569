/// @file
/// Checks the whole data structure after each kernel of random adaptations.
#include "adapt/adapter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/make_mesh.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/metrics.hpp"
#include "support/preserved.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::adapter_test {
namespace {

using runtime::Executor;

template <int Dim>
void check_after_each_kernel(const Executor& executor, const test::RandomCase& random) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, random.mesh, random.options.make, neighbours, warnings);
  std::vector<Metric<Dim>> metric_of(random.mesh.vertex_count());
  for (std::size_t v = 0; v < metric_of.size(); ++v)
    std::copy_n(&random.metric.values[v * Metric<Dim>::size], Metric<Dim>::size,
                metric_of[v].m.begin());
  AdaptOptions options = random.options;
  const Adapter<Dim>* driver = nullptr;
  bool sound = true;
  options.progress = [&](const AdaptProgress& progress) {
    if (!sound) return true;
    const auto faults = check_mesh(executor, driver->mesh());
    sound = faults.empty();
    EXPECT_TRUE(sound) << "after " << progress.step << " in iteration " << progress.iteration
                       << test::joined(faults);
    return true;
  };
  AdaptReport report;
  Adapter<Dim> adapter(executor, options,
                       {std::move(mesh), std::move(neighbours), std::move(metric_of)}, report);
  driver = &adapter;
  const auto faults = check_mesh(executor, adapter.mesh());
  sound = faults.empty();
  EXPECT_TRUE(sound) << "at the start" << test::joined(faults);
  adapter.run(Effort::as_needed);
}

TEST(Adapter, EachKernelLeavesTheMeshSound) {
  const std::uint64_t first = test::first_trial(1000), end = first + test::trials(24);
  for (std::uint64_t seed = first; seed < end; ++seed) {
    const test::RandomCase random = test::random_case(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
    const Executor executor(
        {.threads = static_cast<int>(1 + seed % 3), .deterministic = seed % 5 != 4});
    if (random.mesh.dimension == 2)
      check_after_each_kernel<2>(executor, random);
    else
      check_after_each_kernel<3>(executor, random);
  }
}

/// A random arc of one or two regions, rippled, with or without listed ridges, and a random metric;
/// curved parts may change.
test::RandomCase random_arc(std::uint64_t seed) {
  test::Random random(seed);
  const int dimension = seed % 2 == 0 ? 2 : 3, n = dimension == 2 ? 16 : 6;
  test::Grid grid = test::unit_grid(dimension, n);
  if (test::chance(random, 0.3)) grid.region = test::two_halves(n);
  if (test::chance(random, 0.2)) grid.region = test::with_hole(n);
  test::RandomCase arc{.mesh = test::make_grid(grid), .metric = {}, .options = {}, .what = "arc"};
  if (dimension == 3 && test::chance(random, 0.5)) test::list_ridges(arc.mesh);
  const double waves = test::uniform(random, 1, 9), amount = test::uniform(random, 0, 0.3) / waves;
  auto& coordinates = arc.mesh.coordinates;
  for (std::size_t at = 0; at < coordinates.size(); at += static_cast<std::size_t>(dimension))
    coordinates[at] += amount * std::sin(waves * coordinates[at + 1] + 1);
  test::bend(arc.mesh, test::uniform(random, 0.5, 3));
  test::jiggle(arc.mesh, random, 0.2);
  arc.metric = test::wild_field(arc.mesh, random, 1.5, test::uniform(random, 1, 6));
  test::scale_to(arc.metric, arc.mesh,
                 (dimension == 2 ? 200 : 100) * test::uniform(random, 0.01, 2));
  arc.options.make.hausdorff_tolerance = std::pow(10, test::uniform(random, -3, 0));
  if (test::chance(random, 0.3)) arc.options.gradation = test::uniform(random, 1.2, 3);
  return arc;
}

TEST(Adapter, EachKernelLeavesCurvedBoundariesSound) {
  for (std::uint64_t seed = 0; seed < test::trials(16); ++seed) {
    SCOPED_TRACE(seed);
    const test::RandomCase random = random_arc(seed);
    const Executor executor(
        {.threads = static_cast<int>(1 + seed % 3), .deterministic = seed % 5 != 4});
    if (random.mesh.dimension == 2)
      check_after_each_kernel<2>(executor, random);
    else
      check_after_each_kernel<3>(executor, random);
    const AdaptedMesh result = adapt(executor, random.mesh, random.metric, random.options);
    EXPECT_EQ(test::joined(check_mesh(executor, result.mesh)), "");
    EXPECT_EQ(test::joined(check_domain(executor, random.mesh, result.mesh,
                                        random.options.make.hausdorff_tolerance)),
              "");
    EXPECT_TRUE(!check_boundary(executor, random.mesh).empty() ||
                check_boundary(executor, result.mesh).empty());
  }
}

}  // namespace
}  // namespace ductile::meshadapt::adapter_test
