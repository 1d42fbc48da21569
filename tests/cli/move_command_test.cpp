/// @file
/// `ductile move` and `ductile adapt -lag` on files: outputs equal the library's results, and what
/// does not fit is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"
#include "program.hpp"
#include "support/meshes.hpp"

namespace ductile::cli::move_command_test {
namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
namespace test = meshadapt::test;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A square with a body of reference 3 that has a displacement, and a field.
struct Files {
  explicit Files(double way) {
    test::Grid grid = test::unit_grid(2, 12);
    grid.region = [](const test::Cell& cell) {
      return cell[0] >= 2 && cell[0] < 5 && cell[1] >= 5 && cell[1] < 8 ? 3 : 2;
    };
    mesh = test::make_grid(grid);
    std::vector<meshadapt::Vector<2>> vectors(mesh.vertex_count());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.triangles.reference[t] == 3)
        for (const auto v : mesh.triangles.vertices[t]) vectors[v] = {{way, 0.02}};
    displacement = meshadapt::vector_field(vectors);
    field = meshadapt::scalar_field(2, std::vector<double>(mesh.vertex_count(), 2));
    meshadapt::write_mesh(path("a.mesh"), mesh);
    meshadapt::write_field(path("u.sol"), displacement);
    meshadapt::write_field(path("f.sol"), field);
  }
  std::filesystem::path path(const char* name) const { return folder.path() / name; }

  Folder folder;
  AnyMesh mesh;
  AnyField displacement, field;
};

TEST(MoveCommand, WritesWhatTheLibraryGives) {
  const Files files(0.4);
  const Outcome outcome =
      files.folder.run("move a.mesh u.sol --bodies 3 --field f.sol -o b.mesh --threads 2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "moved 100 % of the way"));
  const runtime::Executor executor({.threads = 1});
  const auto fields = meshadapt::named_fields(files.field, "f");
  const auto moved =
      meshadapt::move(executor, files.mesh, files.displacement,
                      {.fields = fields, .carrying = {meshadapt::Carrying::conservatively}});
  const AnyMesh written = meshadapt::read_mesh(files.path("b.mesh"));
  EXPECT_EQ(written.coordinates, moved.mesh.coordinates);
  EXPECT_EQ(written.triangles, moved.mesh.triangles);
  EXPECT_EQ(written.edges, moved.mesh.edges);
  EXPECT_EQ(meshadapt::read_field(files.path("b.sol")).values, moved.metric.values);
  EXPECT_EQ(meshadapt::read_field(files.path("b.f.sol")).values, moved.fields[0].values);
}

TEST(MoveCommand, WritesNoMetricInAnyFormatIfNoneIsWanted) {
  const Files files(0.1);
  for (const std::string options : {"", " --no-metric"})
    for (const std::string ending : {".mesh", ".meshb", ".msh", ".vtu", ".vtk", ".su2"}) {
      const std::string words = "move a.mesh u.sol --field f.sol -o b" + ending + options;
      const Outcome outcome = files.folder.run(words);
      ASSERT_EQ(outcome.status, 0) << words << outcome.err;
      bool found = false;
      for (const auto& field :
           meshadapt::read_mesh_with_fields(files.path(("b" + ending).c_str())).fields)
        found = found || field.name == "metric";
      for (const char* beside : {"b.sol", "b.solb"})
        found = std::filesystem::remove(files.path(beside)) || found;
      EXPECT_EQ(found, options.empty()) << words;
    }
}

TEST(MoveCommand, MmgsOptionAllowsWhatMmgDoes) {
  const Files files(0.4);
  ASSERT_EQ(files.folder.run("move a.mesh u.sol -o b.mesh").status, 0);
  const AnyMesh before = meshadapt::read_mesh(files.path("a.mesh")),
                moved = meshadapt::read_mesh(files.path("b.mesh"));
  const auto lagged = [](const Files& in, const char* lag) {
    const Outcome outcome =
        in.folder.run(std::string("adapt a.mesh -sol u.sol -o c.mesh -lag ") + lag);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return meshadapt::read_mesh(in.path("c.mesh"));
  };
  EXPECT_EQ(lagged(files, "2").coordinates, moved.coordinates);
  EXPECT_NE(moved.vertex_count(), before.vertex_count());
  const Files near(0.35);
  const AnyMesh swapped = lagged(near, "1");
  EXPECT_EQ(swapped.vertex_count(), before.vertex_count());
  EXPECT_NE(swapped.triangles, before.triangles);
  const Files nearer(0.05);
  EXPECT_EQ(lagged(nearer, "0").triangles, before.triangles);
  const Files far(0.55);
  const Outcome held = far.folder.run("adapt a.mesh -lag 0 -sol u.sol -o d.mesh");
  EXPECT_EQ(held.status, 1);
  EXPECT_TRUE(contains(held.err, "stopped at")) << held.err;
  const Outcome other = files.folder.run("adapt a.mesh -lag 1 -sol u.sol -hausd 1 -o d.mesh");
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "options -lag and -hausd")) << other.err;
}

/// Nothing that a mesh's file holds is lost without a warning.
TEST(MoveCommand, FieldsOfTheMeshGoAlong) {
  const Files files(0.4);
  std::vector<double> marks;
  for (const auto reference : files.mesh.triangles.reference) marks.push_back(reference);
  const std::vector<double> load(marks.size(), 1.5);
  const auto sizes = meshadapt::constant_metric(files.mesh, 0.05);
  using Place = meshadapt::NamedField::Place;
  const std::vector<meshadapt::NamedField> fields{
      {"shift", AnyField::Type::vector, files.displacement.values},
      {"heat", AnyField::Type::scalar, files.field.values},
      {"load", AnyField::Type::scalar, load, Place::elements},
      {"material", AnyField::Type::scalar, marks, Place::elements, true},
      {"metric", AnyField::Type::symmetric, sizes.values}};
  meshadapt::write_mesh(files.path("a.vtu"), files.mesh, {.fields = fields});
  ASSERT_EQ(files.folder.run("move a.vtu shift -o b.vtu --json b.json").status, 0);
  const auto moved = meshadapt::read_mesh_with_fields(files.path("b.vtu"));
  std::string names;
  for (const auto& field : moved.fields) names += field.name + " ";
  EXPECT_EQ(names, "metric heat load material ");
  for (const auto& field : moved.fields)
    if (field.name == "material") {
      for (std::size_t t = 0; t < field.values.size(); ++t)
        EXPECT_EQ(field.values[t], moved.mesh.triangles.reference[t]);
    }
  // The file's metric is the one to adapt to.
  EXPECT_GT(moved.mesh.triangles.size(), 1.1 * static_cast<double>(files.mesh.triangles.size()));
  const std::string json = files.folder.read("b.json");
  for (const char* part : {"\"before\": {\"file\": \"a.vtu\"", "\"share\": 1,", "\"stopped\": null",
                           "\"quality\"", "\"warnings\": []"})
    EXPECT_TRUE(contains(json, part)) << part << json;
  const Outcome outcome = files.folder.run("move a.vtu shift -o c.mesh --json -");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.err, "a.vtu: its fields are not carried: heat, load, material"))
      << outcome.err;
  EXPECT_EQ(outcome.out.front(), '{');
  EXPECT_EQ(files.folder.run("move a.vtu shift -o d.vtu --turn nothing").status, 2);
}

TEST(MoveCommand, ABlockedWayWritesNothingUnlessAsked) {
  const Files files(0.9);
  const Outcome blocked = files.folder.run("move a.mesh u.sol -o b.mesh");
  EXPECT_EQ(blocked.status, 1);
  EXPECT_TRUE(contains(blocked.err, "a.mesh: expected to move bodies all the way, stopped at"))
      << blocked.err;
  EXPECT_FALSE(std::filesystem::exists(files.path("b.mesh")));
  const Outcome partial = files.folder.run("move a.mesh u.sol -o b.mesh --keep-partial");
  EXPECT_EQ(partial.status, 1);
  EXPECT_TRUE(contains(partial.err, "warning: the way was not gone to its end")) << partial.err;
  EXPECT_GT(meshadapt::read_mesh(files.path("b.mesh")).triangles.size(), 0U);
}

TEST(MoveCommand, WhatDoesNotFitIsRefused) {
  const Files files(0.1);
  const auto refused = [&](const std::string& words, const std::string& part) {
    const Outcome outcome = files.folder.run(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, part)) << outcome.err;
  };
  refused("move a.mesh", "expected a mesh and a displacement, found 1 word");
  refused("move a.mesh f.sol -o b.mesh", "f.sol: expected one vector at each vertex");
  refused("move a.mesh u.sol --bodies 3,x", "--bodies");
  refused("move a.mesh u.sol --bodies 4", "bodies: expected references of elements, found 4");
  refused("move a.mesh u.sol -met f.sol -hsiz 1", "options -met and -hsiz");
  refused("move a.mesh u.sol -o u.sol", "u.sol");
}

}  // namespace
}  // namespace ductile::cli::move_command_test
