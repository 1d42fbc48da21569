/// @file
/// Adapts random meshes to random metrics; every result must be a valid mesh that keeps what it
/// must. DUCTILE_TRIALS is the number of cases (default 60), DUCTILE_FIRST_TRIAL the first one, and
/// DUCTILE_TRIAL_FOLDER a folder for inputs and outputs, if wanted.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "ductile/meshadapt/files.hpp"
#include "support/preserved.hpp"
#include "support/random_case.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::random_meshes_test {
namespace {

using runtime::Executor;

void write_files(const std::string& name, const AnyMesh& mesh, const AnyField& metric) {
  const char* folder = std::getenv("DUCTILE_TRIAL_FOLDER");
  if (folder == nullptr) return;
  const std::filesystem::path base = std::filesystem::path(folder) / name;
  write_mesh(base.string() + ".mesh", mesh);
  write_field(base.string() + ".sol", metric);
}

void try_case(std::uint64_t seed) {
  test::RandomCase random = test::random_case(seed);
  SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
  const std::string name = "case" + std::to_string(seed);
  write_files(name, random.mesh, random.metric);
  const bool racing = seed % 5 == 4;
  const Executor executor({.threads = static_cast<int>(1 + seed % 3), .deterministic = !racing});
  const auto start = std::chrono::steady_clock::now();
  const AdaptedMesh result = adapt(executor, random.mesh, random.metric, random.options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  write_files(name + ".o", result.mesh, result.metric);
  if (random.options.make.lock_boundary) test::require_facets(random.mesh);
  const auto faults = test::faults_of(executor, random.mesh, result);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  EXPECT_LT(seconds.count(), 60) << "it took too long";
  const std::size_t size = result.mesh.triangles.size() + result.mesh.tetrahedra.size();
  EXPECT_LT(size, 150000U) << "there are far more elements than the metric asks for";
  if (std::getenv("DUCTILE_TRIAL_FOLDER") != nullptr)
    std::printf("%llu %zu %.2fs %s\n", static_cast<unsigned long long>(seed), size, seconds.count(),
                random.what.c_str());
}

TEST(RandomMeshes, AreValidAfterAdaptation) {
  for (auto seed = test::first_trial(); seed < test::end_of_trials(60); ++seed)
    ASSERT_NO_THROW(try_case(seed)) << "seed " << seed;
}

}  // namespace
}  // namespace ductile::meshadapt::random_meshes_test
