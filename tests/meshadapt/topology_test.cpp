/// @file
/// Adapts random meshes whose boundary comes close to itself, with larger surface tolerances: each
/// result must be valid and have the topology of the input. DUCTILE_TRIALS is the number of cases
/// of each kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/counted_topology.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/thin_cases.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::topology_test {
namespace {

using runtime::Executor;

std::vector<std::string> counted(const AnyMesh& mesh) {
  return mesh.dimension == 2 ? test::counted_topology<2>(mesh) : test::counted_topology<3>(mesh);
}

/// Returns the number of attempts.
int try_case(const test::ThinCase& thin) {
  const AnyField metric = constant_metric(thin.mesh, thin.size);
  AdaptOptions options;
  options.make.hausdorff_tolerance = thin.tolerance;
  const Executor one({.threads = 1}), two({.threads = 2});
  if (const char* folder = std::getenv("DUCTILE_TRIAL_FOLDER"))
    write_mesh(std::string(folder) + "/in.mesh", thin.mesh);
  const AdaptedMesh result = adapt(one, thin.mesh, metric, options);
  EXPECT_EQ(test::joined(check_adapted(one, thin.mesh, result.mesh, thin.tolerance)), "");
  EXPECT_EQ(test::joined(counted(result.mesh)), test::joined(counted(thin.mesh)));
  const AdaptedMesh again = adapt(two, thin.mesh, metric, options);
  EXPECT_EQ(again.mesh, result.mesh);
  EXPECT_EQ(again.metric.values, result.metric.values);
  return result.report.attempts;
}

using Make = std::function<test::ThinCase(int, std::uint64_t)>;

void try_many(const Make& make) {
  std::array<std::array<int, 10>, 4> attempts{};
  for (auto seed = test::first_trial(); seed < test::end_of_trials(100); ++seed) {
    const int dimension = seed % 2 == 0 ? 2 : 3;
    const test::ThinCase thin = make(dimension, seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + thin.what);
    int here = 0;
    EXPECT_NO_THROW(here = try_case(thin));
    ++attempts[static_cast<std::size_t>(dimension)][static_cast<std::size_t>(std::min(here, 9))];
  }
  for (int dimension : {2, 3}) {
    std::printf("%dD, cases by attempts:", dimension);
    for (const int n : attempts[static_cast<std::size_t>(dimension)]) std::printf(" %d", n);
    std::printf("\n");
  }
}

/// Random cells of a coarse grid, each cut into `cut` cells along each axis.
AnyMesh random_cells(int dimension, std::uint64_t seed, int cut, int regions) {
  const auto coarse = test::random_regions(seed, regions, true);
  test::Grid grid = test::unit_grid(dimension, (dimension == 2 ? 4 : 3) * cut);
  grid.region = [=](const test::Cell& cell) {
    return coarse({cell[0] / cut, cell[1] / cut, cell[2] < 0 ? cell[2] : cell[2] / cut});
  };
  return test::make_grid(grid);
}

std::string differences(const AnyMesh& before, const AnyMesh& after) {
  const auto faults = check_topology(Executor({.threads = 2}), before, after);
  return faults.empty() ? "" : faults.front();
}

TEST(CheckTopology, FindsNothingInMeshesOfOneDomain) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const int dimension = seed % 2 == 0 ? 2 : 3, regions = 1 + static_cast<int>(seed / 2 % 3);
    AnyMesh before = random_cells(dimension, seed, 1, regions);
    const AnyMesh after = random_cells(dimension, seed, 2, regions);
    EXPECT_EQ(differences(before, after), "");
    before.edges = {};  // edges need not be listed
    before.triangles = dimension == 2 ? before.triangles : Cells<3>{};
    EXPECT_EQ(differences(before, after), "");
  }
}

TEST(CheckTopology, FindsAllThatCountingFinds) {
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const int dimension = seed % 2 == 0 ? 2 : 3, regions = seed % 3 == 0 ? 2 : 1;
    const AnyMesh one = random_cells(dimension, seed, 1, regions);
    const AnyMesh other = random_cells(dimension, seed + 1000, 1, regions);
    const bool differ = counted(one) != counted(other);
    found += differ;
    EXPECT_TRUE(!differ || !differences(one, other).empty());
  }
  EXPECT_GT(found, 40U);
}

TEST(CheckTopology, SaysWhatDiffers) {
  for (const int dimension : {2, 3}) {
    test::Grid grid = test::unit_grid(dimension, 3);
    const AnyMesh whole = test::make_grid(grid);
    grid.region = test::with_hole(3);
    EXPECT_EQ(differences(whole, test::make_grid(grid)),
              "the domain: the number of parts of the boundary is 2, expected 1");
    grid.region = [](const test::Cell& cell) { return cell[0] == 1 ? 0 : 1; };
    EXPECT_EQ(differences(whole, test::make_grid(grid)),
              "the domain: the number of parts is 2, expected 1");
  }
  test::Grid ring = test::unit_grid(3, 3);
  ring.region = [](const test::Cell& cell) { return cell[0] == 1 && cell[1] == 1 ? 0 : 1; };
  EXPECT_EQ(differences(test::make_grid(test::unit_grid(3, 3)), test::make_grid(ring)),
            "the domain: the Euler characteristic of the boundary is 0, expected 2");
}

TEST(CheckTopology, RefusesVerticesThatAreNotThere) {
  const AnyMesh right = test::make_grid(test::unit_grid(2, 2));
  AnyMesh wrong = right;
  wrong.triangles.vertices[3][1] = 1000;
  EXPECT_THROW(differences(right, wrong), InputError);
  EXPECT_THROW(differences(wrong, right), InputError);
  EXPECT_THROW(differences(right, test::make_grid(test::unit_grid(3, 2))), InputError);
}

TEST(Topology, OfPlatesWithVoidsIsKept) { try_many(test::plate_with_voids); }
TEST(Topology, OfPlatesWithJoinedVoidsIsKept) { try_many(test::plate_with_joined_voids); }
TEST(Topology, OfCurvedClosedCracksIsKept) { try_many(test::curved_crack); }
TEST(Topology, OfBodiesInContactIsKept) { try_many(test::bodies_in_contact); }

}  // namespace
}  // namespace ductile::meshadapt::topology_test
