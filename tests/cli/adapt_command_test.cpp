#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "adapt_report.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "program.hpp"
#include "support/trials.hpp"

namespace ductile::cli::adapt_command_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(AdaptCommand, TakesTheMetricBesideTheMeshAndWritesBesideIt) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome = folder.run("adapt waves2d.mesh");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "written: waves2d.o.mesh, waves2d.o.sol")) << outcome.out;
  EXPECT_EQ(folder.run("info waves2d.o.mesh -sol waves2d.o.sol").status, 0);
  EXPECT_EQ(folder.file_count(), 4U);
}

TEST(AdaptCommand, WritesBinaryForBinary) {
  const Folder folder;
  folder.add_example("waves3d");
  folder.run("convert waves3d.mesh b.meshb");
  folder.run("convert waves3d.sol b.solb");
  const Outcome outcome = folder.run("adapt b.meshb --iterations 1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(folder.has("b.o.meshb"));
  EXPECT_TRUE(folder.has("b.o.solb"));
}

TEST(AdaptCommand, DoesNotDependOnThreads) {
  if (meshadapt::test::address_sanitized) GTEST_SKIP() << meshadapt::test::compares_threads;
  const Folder folder;
  folder.add_example("waves3d");
  for (const char* threads : {"1", "2", "4"})
    EXPECT_EQ(folder
                  .run(std::string("adapt waves3d.mesh --iterations 1 --threads ") + threads +
                       " -o " + threads + ".mesh")
                  .status,
              0);
  EXPECT_EQ(folder.read("1.mesh"), folder.read("2.mesh"));
  EXPECT_EQ(folder.read("1.mesh"), folder.read("4.mesh"));
  EXPECT_EQ(folder.read("1.sol"), folder.read("4.sol"));
}

TEST(AdaptCommand, TakesMmgsOptions) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome = folder.run(
      "adapt waves2d.mesh -sol waves2d.sol -out a.mesh -hmin 0.01 -hmax 0.2 -hgrad 1.5 -nomove "
      "-noswap -noinsert -nosurf -v 0 -m 1000000000");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(folder.has("a.mesh"));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
// Sanitizers need more memory and larger files than these limits leave them.
TEST(AdaptCommand, FailsCleanlyWhenMemoryRunsOut) {
  const Folder folder;
  folder.add_example("waves3d");
  for (const char* threads : {"1", "64"}) {
    const Outcome outcome =
        folder.run(std::string("adapt waves3d.mesh -m 10 --threads ") + threads);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "out of memory")) << outcome.err;
  }
  EXPECT_EQ(folder.file_count(), 2U);
}

/// Threads reserve 500 MB of addresses for their stacks.
TEST(AdaptCommand, DoesNotTakeAddressesForMemory) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome =
      folder.run("adapt waves2d.mesh -m 100 --threads 64 --iterations 1 -o out.mesh");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(AdaptCommand, FailsCleanlyWhenFilesMayNotGrow) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome = folder.run("adapt waves2d.mesh", "ulimit -f 8 &&");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "waves2d.o.mesh: cannot write, File too large")) << outcome.err;
  EXPECT_EQ(folder.file_count(), 2U);
}
#endif

TEST(AdaptCommand, TakesTheMetricByEitherOfMmgsNames) {
  const Folder folder;
  folder.add_example("waves2d");
  std::filesystem::rename(folder.path() / "waves2d.sol", folder.path() / "m.sol");
  const Outcome sol = folder.run("adapt waves2d.mesh -sol m.sol -o sol.mesh");
  EXPECT_EQ(sol.status, 0) << sol.err;
  const Outcome met = folder.run("adapt waves2d.mesh -met m.sol -o met.mesh");
  EXPECT_EQ(met.status, 0) << met.err;
  EXPECT_EQ(folder.read("sol.mesh"), folder.read("met.mesh"));
}

TEST(AdaptCommand, AdaptsToOneSizeAndToTheSizesThatThereAre) {
  const Folder folder;
  folder.add_example("waves2d");
  EXPECT_EQ(folder.run("adapt waves2d.mesh -hsiz 0.1 -o one.mesh").status, 0);
  std::filesystem::remove(folder.path() / "waves2d.sol");
  const Outcome outcome = folder.run("adapt waves2d.mesh -o same.mesh");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.err, "no metric given")) << outcome.err;
}

TEST(AdaptCommand, AdaptsToSizesByPlacesThatTheMeshDoesNotShow) {
  const Folder folder;
  auto box = meshadapt::box_mesh<2>({1, 1}, {2, 2});
  box.names = {{1, 1, "wall"}};
  meshadapt::write_mesh(folder.path() / "a.msh", box);
  meshadapt::write_mesh(folder.path() / "line.mesh", box);
  folder.write("a.mmg2d", "Parameters 1\n1 Edge 0.01 0.011 0\n");
  const auto elements = [&](const std::string& words) {
    const Outcome outcome = folder.run("adapt a.msh " + words + " -v 0 -o b.meshb");
    EXPECT_EQ(outcome.status, 0) << words << ": " << outcome.err;
    return meshadapt::read_mesh(folder.path() / "b.meshb").triangles.size();
  };
  // The number of triangles around a point for a size of 0.01 that grows by 0.26 per unit of
  // length.
  const std::size_t around = elements("-hsiz .5 --near point:.3,.6:.01");
  EXPECT_GT(around, 200U);
  EXPECT_LT(around, 1000U);
  const std::size_t beside = elements("-hsiz .5 --on wall:.01:1.5"), in = elements("--inside 1:.1");
  EXPECT_GT(beside, 200U);
  EXPECT_LT(beside, 1500U);
  EXPECT_GT(in, 180U);
  EXPECT_LT(in, 300U);
  EXPECT_LT(elements("-hsiz .2 --near point:0,0:.2 -hmax .1"), elements("-hsiz .1"))
      << "of a.mmg2d";
  struct Line {
    const char *words, *text;
  };
  for (const auto& [words, text] : std::initializer_list<Line>{
           {"-sol a.sol --near point:0,0:.1", "options -sol and --near: expected one of them"},
           {"-optim --on wall:.1 --inside 1:.1", "options -optim and --on: expected one of them"},
           {"-f a.mmg2d --inside 1:.1", "options -f and --inside: expected one of them"},
           {"--on wal:.1", "option --on wal:.1: expected a name that the mesh has (wall)"},
           {"--near ball:0,0:.1", "expected point, sphere, box, line or file"},
           {"--near file:line.mesh:.1 -o line.mesh", "is read, and would be replaced"}}) {
    const Outcome outcome = folder.run("adapt a.msh -o c.mesh " + std::string(words));
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, text)) << words << ": " << outcome.err;
  }
  EXPECT_FALSE(folder.has("c.mesh"));
}

TEST(AdaptCommand, ReportsAsJsonAndForParaView) {
  const Folder folder;
  folder.add_example("waves2d");
  EXPECT_EQ(folder.run("adapt waves2d.mesh --json r.json --vtu r.vtu --racing").status, 0);
  const std::string json = folder.read("r.json");
  for (const char* part :
       {"\"before\"", "\"after\"", "\"coarsen\"", "\"seconds\"", "\"threads\"",
        "\"peak_memory_bytes\"", "\"deterministic\": false", "\"instructions\"", "\"quality\""})
    EXPECT_TRUE(contains(json, part)) << part;
  EXPECT_TRUE(contains(folder.read("r.vtu"), "UnstructuredGrid"));
}

TEST(AdaptSummary, WarnsOfEdgesThatAreTooLong) {
  const Folder folder;
  folder.add_example("waves2d");
  const auto mesh = meshadapt::read_mesh(folder.path() / "waves2d.mesh");
  const runtime::Executor executor({.threads = 1});
  const auto warnings_for = [&](double size, bool expects_lengths) {
    const meshadapt::AdaptedMesh as_it_is{mesh, meshadapt::constant_metric(mesh, size), {}};
    return summarise({executor, mesh}, as_it_is.metric, as_it_is, {executor, as_it_is.mesh},
                     {.before = false, .expects_lengths = expects_lengths})
        .report.warnings;
  };
  ASSERT_EQ(warnings_for(1e-3, true).size(), 1U);
  EXPECT_TRUE(contains(warnings_for(1e-3, true).front(), "100 % of the edges are longer"));
  EXPECT_TRUE(warnings_for(1e-3, false).empty());
  EXPECT_TRUE(warnings_for(1e3, true).empty());
}

/// Writes arc.mesh, with radii from 1 to 2.
void add_arc(const Folder& folder) {
  meshadapt::AnyMesh mesh = meshadapt::box_mesh<2>({1, 1}, {40, 40});
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += 2) {
    const double radius = 1 + mesh.coordinates[at], angle = mesh.coordinates[at + 1];
    mesh.coordinates[at] = radius * std::cos(angle);
    mesh.coordinates[at + 1] = radius * std::sin(angle);
  }
  meshadapt::write_mesh(folder.path() / "arc.mesh", mesh);
}

TEST(AdaptCommand, SaysWhereTheToleranceKeepsEdgesShort) {
  const Folder folder;
  add_arc(folder);
  const auto said = [&](const std::string& options) {
    const Outcome outcome = folder.run("adapt arc.mesh --no-metric " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.err;
  };
  const std::string binding = said("-hsiz 0.4 -hausd 0.0001");
  EXPECT_TRUE(contains(binding, "% of the edges are shorter than asked for")) << binding;
  EXPECT_TRUE(contains(binding, "within 0.0001 (-hausd)")) << binding;
  EXPECT_EQ(said("-hsiz 0.4 -hausd 0.05"), "");
  EXPECT_EQ(said("-hsiz 0.01 -hausd 0.0001"), "");
  EXPECT_EQ(said("-hsiz 0.4 -hausd 0.0001 -noinsert"), "");
  EXPECT_EQ(said("-hsiz 0.4 -hausd 0.0001 -nosurf"), "");
}

TEST(AdaptCommand, CoarsensACurvedBoundaryIfToldTo) {
  const Folder folder;
  add_arc(folder);
  const Outcome kept = folder.run("adapt arc.mesh -hsiz 0.3");
  EXPECT_EQ(kept.status, 0);
  EXPECT_TRUE(contains(kept.err, "-hausd")) << kept.err;
  const Outcome coarsened = folder.run("adapt arc.mesh -hsiz 0.3 -hausd 0.01 -o coarse.mesh");
  EXPECT_EQ(coarsened.status, 0);
  EXPECT_FALSE(contains(coarsened.err, "-hausd")) << coarsened.err;
  EXPECT_LT(meshadapt::read_mesh(folder.path() / "coarse.mesh").edges.size(),
            meshadapt::read_mesh(folder.path() / "arc.o.mesh").edges.size() / 3);
  const Outcome ridges = folder.run("adapt arc.mesh -hsiz 0.3 -hausd 0.01 -ar 1 -o ridges.mesh");
  EXPECT_EQ(ridges.status, 0);
  EXPECT_TRUE(contains(ridges.err, "larger angle -ar")) << ridges.err;
  EXPECT_FALSE(contains(coarsened.err, "-ar")) << coarsened.err;
  EXPECT_EQ(meshadapt::read_mesh(folder.path() / "ridges.mesh").edges.size(),
            meshadapt::read_mesh(folder.path() / "arc.o.mesh").edges.size());
  const Outcome again =
      folder.run("adapt coarse.mesh -hsiz 0.1 -hausd 0.01 -geometry arc.mesh -o again.mesh");
  EXPECT_EQ(again.status, 0) << again.err;
  const Outcome other =
      folder.run("adapt coarse.mesh -hsiz 0.1 -hausd 0.001 -geometry arc.mesh -o other.mesh");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "from the geometry")) << other.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "other.mesh"));
  const Outcome alone = folder.run("adapt arc.mesh -A -hausd 0.01 -o alone.mesh");
  EXPECT_EQ(alone.status, 0) << alone.err;
  EXPECT_LT(meshadapt::read_mesh(folder.path() / "alone.mesh").edges.size(),
            meshadapt::read_mesh(folder.path() / "arc.o.mesh").edges.size() / 2);
  for (const char* wrong : {"-hausd 0", "-hausd 0.01 -ar 90", "-hausd 0.01 -ar 0",
                            "-geometry arc.mesh", "-hausd 0.01 -A"})
    EXPECT_EQ(folder.run(std::string("adapt arc.mesh -hsiz 0.3 ") + wrong).status, 2) << wrong;
  EXPECT_EQ(folder.run("adapt arc.mesh -A").status, 2);
}

TEST(AdaptCommand, RefusesSizesThatNoMetricCanHave) {
  const Folder folder;
  folder.add_example("waves2d");
  for (const char* size : {"1e300", "1e-300"}) {
    const Outcome outcome = folder.run(std::string("adapt waves2d.mesh -hsiz ") + size);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "1e-75 to 1e75")) << outcome.err;
  }
}

TEST(AdaptCommand, LeavesOutEdgesOfNoElementAsInfoSays) {
  const Folder folder;
  meshadapt::AnyMesh mesh = meshadapt::box_mesh({1, 1, 1}, {2, 2, 2});
  mesh.edges.add({0, 26}, 7);
  meshadapt::write_mesh(folder.path() / "box.mesh", mesh);
  for (const char* command : {"info box.mesh", "adapt box.mesh -hsiz 0.5"}) {
    const Outcome outcome = folder.run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "1 of 1 listed edges belong to no tetrahedron"))
        << outcome.err;
  }
  EXPECT_EQ(meshadapt::read_mesh(folder.path() / "box.o.mesh").edges.size(), 0U);
}

/// Writes u.sol, a scalar x + y and a vector, at the vertices of a mesh in the folder.
void add_field(const Folder& folder, const std::string& mesh_name) {
  const auto mesh = meshadapt::read_mesh(folder.path() / mesh_name);
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  meshadapt::AnyField field{mesh.dimension, mesh.vertex_count(), {}, {}, {}};
  field.types = {meshadapt::AnyField::Type::scalar, meshadapt::AnyField::Type::vector};
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const double* const x = &mesh.coordinates[v * dimension];
    field.values.push_back(x[0] + x[1]);
    field.values.insert(field.values.end(), x, x + dimension);
  }
  meshadapt::write_field(folder.path() / "u.sol", field);
}

TEST(AdaptCommand, CarriesFieldsAlong) {
  for (const std::string name : {"waves2d", "waves3d"})
    for (const char* how : {"", " --interpolate"}) {
      const Folder folder;
      folder.add_example(name);
      add_field(folder, name + ".mesh");
      const Outcome outcome =
          folder.run("adapt " + name + ".mesh --iterations 1 -hmin 0.05 --field u.sol" +
                     " --vtu a.vtu -o a.mesh" + how);
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_TRUE(contains(outcome.out, "written: a.mesh, a.sol, a.u.sol")) << outcome.out;
      EXPECT_TRUE(contains(folder.read("a.vtu"), "u_2"));
      const auto carried = meshadapt::read_field(folder.path() / "a.u.sol").values;
      add_field(folder, "a.mesh");
      const auto exact = meshadapt::read_field(folder.path() / "u.sol").values;
      ASSERT_EQ(carried.size(), exact.size());
      for (std::size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(carried[i], exact[i], 1e-9);
    }
}

TEST(AdaptCommand, RefusesAFieldOfAnotherMesh) {
  const Folder folder;
  folder.add_example("waves2d");
  folder.write("u.sol",
               "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 1\n1\n1\n1\nEnd\n");
  const Outcome outcome = folder.run("adapt waves2d.mesh --field u.sol");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "u.sol: expected 625 values")) << outcome.err;
  EXPECT_EQ(folder.run("adapt waves2d.mesh --interpolate").status, 2);
  EXPECT_EQ(folder.file_count(), 3U);
}

TEST(AdaptCommand, SaysNothingOfProgressInAPipe) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome outcome = folder.run("adapt waves2d.mesh");
  EXPECT_EQ(outcome.err, "");
  EXPECT_FALSE(contains(outcome.out, "\r"));
  EXPECT_FALSE(contains(outcome.out, "\033"));
}

TEST(AdaptCommand, MovesBoundariesThatWereNotListed) {
  const Folder folder;
  std::string vertices = "17\n0 0 0\n", triangles = "16\n";
  for (int i = 0; i < 16; ++i) {
    const double angle = std::acos(-1.0) / 8 * i;
    vertices += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    triangles += "1 " + std::to_string(2 + i) + " " + std::to_string(2 + (i + 1) % 16) + " 1\n";
  }
  folder.write("a.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices\n" + vertices +
                             "Triangles\n" + triangles + "End\n");
  const Outcome outcome = folder.run("adapt a.mesh -hsiz 0.7 -hausd 0.1 --complete-boundary");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(AdaptCommand, LeavesOldOutputWhenTheInputIsWrong) {
  const Folder folder;
  folder.add_example("waves2d");
  folder.write("waves2d.o.mesh", "old mesh");
  folder.write("waves2d.o.sol", "old metric");
  folder.write("bad.sol",
               "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n3\n1 1\n1\n1\n1\nEnd\n");
  const Outcome outcome = folder.run("adapt waves2d.mesh -sol bad.sol");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "bad.sol")) << outcome.err;
  EXPECT_EQ(folder.read("waves2d.o.mesh"), "old mesh");
  EXPECT_EQ(folder.read("waves2d.o.sol"), "old metric");
  EXPECT_EQ(folder.file_count(), 5U);
}

TEST(AdaptCommand, ReplacesWhatItReadOnlyInPlace) {
  const Folder folder;
  folder.add_example("waves2d");
  const std::string mesh = folder.read("waves2d.mesh"), metric = folder.read("waves2d.sol");
  std::filesystem::create_directory_symlink(".", folder.path() / "here");
  for (const char* arguments :
       {"adapt waves2d.mesh --json waves2d.mesh", "adapt waves2d.mesh --json here/waves2d.sol",
        "info waves2d.mesh --json ./waves2d.mesh", "adapt here/waves2d.mesh --json waves2d.mesh",
        "info waves2d.mesh -sol waves2d.sol --json here/waves2d.sol"}) {
    const Outcome outcome = folder.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_TRUE(contains(outcome.err, "would be replaced")) << outcome.err;
  }
  folder.run("convert waves2d.mesh start.mesh");
  EXPECT_EQ(folder.run("adapt start.mesh -sol waves2d.sol -o waves2d.mesh").status, 2);
  EXPECT_EQ(folder.read("waves2d.mesh"), mesh);
  EXPECT_EQ(folder.read("waves2d.sol"), metric);
  EXPECT_EQ(folder.run("adapt here/waves2d.mesh --iterations 1 -o waves2d.mesh").status, 0);
  EXPECT_NE(folder.read("waves2d.mesh"), mesh);
  EXPECT_NE(folder.read("waves2d.sol"), metric);
}

TEST(AdaptCommand, ChecksItsOutputsBeforeItWorks) {
  const Folder folder;
  folder.add_example("waves2d");
  for (const char* option : {"-o", "--json", "--vtu"}) {
    const Outcome outcome =
        folder.run(std::string("adapt waves2d.mesh ") + option + " nowhere/out." +
                   (std::string(option) == "--vtu" ? "vtu" : "mesh"));
    EXPECT_EQ(outcome.status, 2) << option;
    EXPECT_TRUE(contains(outcome.err, "nowhere")) << outcome.err;
  }
  const Outcome twice = folder.run("adapt none.mesh --json waves2d.vtu --vtu ./waves2d.vtu");
  EXPECT_EQ(twice.status, 2);
  EXPECT_TRUE(contains(twice.err, "two outputs")) << twice.err;
  EXPECT_EQ(folder.file_count(), 2U);
}

}  // namespace
}  // namespace ductile::cli::adapt_command_test
