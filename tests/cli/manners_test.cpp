#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "extents.hpp"
#include "program.hpp"
#include "progress_bar.hpp"

namespace ductile::cli::manners_test {
namespace {

using meshadapt::AnyMesh;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Help, HasEachOptionOfAdaptInAGroup) {
  const Folder folder;
  const std::string help = folder.run("help adapt").out;
  std::size_t last = 0;
  for (const char* group :
       {"Input and output", "Sizes", "Geometry", "Level sets", "Motion", "Quality", "Running"}) {
    const std::size_t at = help.find("\n\n" + std::string(group) + ":\n  -");
    ASSERT_NE(at, std::string::npos) << group << "\n" << help;
    EXPECT_GT(at, last) << group;
    if (last == 0) {
      EXPECT_EQ(help.rfind("\n  -", at), std::string::npos) << "before all groups";
    }
    last = at;
  }
}

TEST(Errors, SayWhatIsWrongInOneLineAndWhatToDoInAnother) {
  const Folder folder;
  folder.add_example("waves2d");
  for (const char* words :
       {"adpat", "nothing-like-it", "adapt", "adapt waves2d.mesh -hmn 1",
        "adapt waves2d.mesh -hmin", "adapt waves2d.mesh --foo", "adapt none.mesh -hsiz 1",
        "adapt waves2d.mesh -hmin -1", "adapt waves2d.mesh -o b.xyz",
        "view waves2d.mesh --by colour", "metric", "metric make", "transfer waves2d.mesh",
        "convert waves2d.mesh", "info waves2d.mesh -sol none.sol", "move waves2d.mesh", "---",
        "adapt waves2d.mesh ---", "adapt waves2d.mesh --- 1"}) {
    const Outcome outcome = folder.run(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(tells_one_error(outcome.err)) << words << ": " << outcome.err;
  }
  EXPECT_TRUE(contains(folder.run("waves2d.mesh -hsiz 1").err, "'ductile adapt waves2d.mesh'?"));
  EXPECT_TRUE(
      contains(folder.run("adapt waves2d.mesh --size 1").err, "  ductile adapt has -hsiz X"));
  for (const char* words : {"adapt waves2d.mesh --foo", "adapt waves2d.mesh -hmn 1", "metric"}) {
    const std::string said = folder.run(words).err;
    EXPECT_TRUE(contains(said, "lists the options")) << said;
  }
}

TEST(ProgressBar, GoesByTheChangesBetweenStepsOfSmoothingAndNeverBack) {
  ProgressBar bar(false);
  const auto share_after = [&](const char* step, std::size_t changes) {
    bar.show({step, 1, changes});
    return bar.share_after({"none", 1, 0});
  };
  EXPECT_EQ(share_after("smooth", 7), 0);
  EXPECT_EQ(share_after("refine", 60), 0);
  EXPECT_EQ(share_after("swap", 40), 0);
  EXPECT_EQ(share_after("smooth", 1000), 0);
  share_after("swap", 20);
  EXPECT_DOUBLE_EQ(share_after("smooth", 900), 0.8);
  share_after("coarsen", 90);
  EXPECT_DOUBLE_EQ(share_after("smooth", 0), 0.8);
  EXPECT_EQ(share_after("smooth", 0), 1);
}

TEST(ProgressBar, IsShownOnATerminalOnly) {
  // The bar is shown on terminals only, and only `script` of util-linux makes one for a test.
  if (std::system("script --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no `script`, which makes a terminal";
  const Folder folder;
  folder.add_example("waves3d");
  const std::string words = " adapt waves3d.mesh -o out.mesh\" terminal > /dev/null; true ";
  folder.run("", "script -q -c \"" DUCTILE_PROGRAM + words + ";");
  const std::string shown = folder.read("terminal");
  EXPECT_TRUE(contains(shown, "\r\033[K[")) << shown;
  EXPECT_TRUE(contains(shown, " s, iteration ")) << shown;
  EXPECT_EQ(folder.run("adapt waves3d.mesh -o out.mesh").err, "");
}

/// The mesh turned, moved and scaled at random.
void turn(AnyMesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-3, 3);
  const double c = std::cos(any(random)), s = std::sqrt(1 - c * c), shift = any(random);
  const auto dim = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += dim) {
    const double x = mesh.coordinates[at], y = mesh.coordinates[at + 1];
    mesh.coordinates[at] = c * x - s * y + shift;
    mesh.coordinates[at + 1] = s * x + c * y;
  }
}

TEST(RidgeCount, CountsTheEdgesOfABoxAndTheCornersOfARectangle) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cells(1, 6);
  for (int trial = 0; trial < 20; ++trial) {
    const int a = cells(random), b = cells(random), c = cells(random);
    AnyMesh flat = meshadapt::box_mesh<2>({1, 1}, {a, b});
    AnyMesh solid = meshadapt::box_mesh<3>({1, 2, 3}, {a, b, c});
    turn(flat, random);
    turn(solid, random);
    EXPECT_EQ(ridge_count(flat, 45), 4U);
    EXPECT_EQ(ridge_count(solid, 45), 4U * static_cast<unsigned>(a + b + c));
    EXPECT_EQ(ridge_count(solid, 91), 0U);
  }
}

/// A disc of radius 1 with so many edges around.
AnyMesh disc(std::uint32_t edges) {
  AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0};
  for (std::uint32_t i = 0; i < edges; ++i) {
    const double angle = 2 * std::numbers::pi * i / edges;
    mesh.coordinates.insert(mesh.coordinates.end(), {std::cos(angle), std::sin(angle)});
    mesh.triangles.add({0, 1 + i, 1 + (i + 1) % edges}, 1);
    mesh.edges.add({1 + i, 1 + (i + 1) % edges}, 1);
  }
  mesh.vertex_reference.assign(edges + 1, 0);
  return mesh;
}

TEST(DistanceTo, IsTheSagOfChords) {
  const runtime::Executor executor({.threads = 2});
  const meshadapt::Geometry circle(executor, disc(2000), {.tolerance = 1e-4});
  for (const std::uint32_t edges : {9U, 20U, 50U, 100U}) {
    const double sag = 1 - std::cos(std::numbers::pi / edges);
    const auto found = distance_to(executor, disc(edges), circle);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, sag, 2e-5) << edges;
    EXPECT_EQ(ridge_count(disc(edges), 45), 0U);
    EXPECT_EQ(ridge_count(disc(edges), 1), edges);
  }
  const AnyMesh box = meshadapt::box_mesh<3>({1, 1, 1}, {2, 2, 2});
  EXPECT_FALSE(distance_to(executor, box, {executor, box, {.tolerance = 0.01}}));
}

TEST(AdaptCommand, SumsUpItsBoundary) {
  const Folder folder;
  folder.add_example("waves3d");
  const Outcome flat = folder.run("adapt waves3d.mesh -hsiz 0.25 -hausd 0.01 --json r.json");
  EXPECT_TRUE(contains(flat.out, " edges of ridges\n")) << flat.out;
  EXPECT_TRUE(contains(flat.out, " s in all)\n")) << flat.out;
  EXPECT_TRUE(contains(folder.read("r.json"), "\"distance\": null")) << folder.read("r.json");
  const Outcome round = folder.run("adapt '" DUCTILE_EXAMPLES
                                   "/bracket.msh' -hsiz 8 -hausd 0.05 -hgrad 1.5 -o b.mesh");
  EXPECT_EQ(round.status, 0) << round.err;
  const std::size_t at = round.out.find(" edges of ridges, within ");
  ASSERT_NE(at, std::string::npos) << round.out;
  const double distance = std::strtod(round.out.c_str() + at + 25, nullptr);
  EXPECT_GT(distance, 0.005);
  EXPECT_LE(distance, 0.055);
}

}  // namespace
}  // namespace ductile::cli::manners_test
