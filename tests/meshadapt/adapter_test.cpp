/// @file
/// Checks the whole data structure after each kernel of random adaptations.
#include "operators/adapter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "ductile/meshadapt/check_mesh.hpp"
#include "support/preserved.hpp"
#include "support/random_case.hpp"

namespace ductile::meshadapt {
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
    if (!sound) return;
    const auto faults = check_mesh(executor, driver->mesh());
    sound = faults.empty();
    EXPECT_TRUE(sound) << "after " << progress.step << " in iteration " << progress.iteration
                       << test::joined(faults);
  };
  Adapter<Dim> adapter(executor, options, std::move(mesh), std::move(neighbours), metric_of);
  driver = &adapter;
  const auto faults = check_mesh(executor, adapter.mesh());
  sound = faults.empty();
  EXPECT_TRUE(sound) << "at the start" << test::joined(faults);
  adapter.run();
}

TEST(Adapter, EachKernelLeavesTheMeshSound) {
  const char* only = std::getenv("DUCTILE_FIRST_TRIAL");
  const std::uint64_t first = only == nullptr ? 1000 : std::strtoull(only, nullptr, 10);
  const char* trials = std::getenv("DUCTILE_TRIALS");
  const std::uint64_t count = trials == nullptr ? 24 : std::strtoull(trials, nullptr, 10);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
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

}  // namespace
}  // namespace ductile::meshadapt
