#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "program.hpp"

namespace ductile::cli::formats_command_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Expects success without a warning.
void expect_done(const Folder& folder, const std::string& words) {
  const Outcome outcome = folder.run(words);
  EXPECT_EQ(outcome.status, 0) << words << "\n" << outcome.err;
  EXPECT_EQ(outcome.err, "") << words;
}

/// Two squares with names, as Gmsh wrote them.
class FormatsCommand : public testing::Test {
 protected:
  FormatsCommand() {
    std::filesystem::copy_file(std::string(DUCTILE_TEST_FILES) + "/square-41-text.msh",
                               folder_.path() / "part.msh");
  }
  /// Expects that the mesh has all names.
  void expect_names(const std::string& mesh) const {
    const std::string info = folder_.run("info " + mesh).out;
    for (const char* part : {"3 (corner): 1", "5 (wall): ", "10 (steel): ", "20 (soft rubber): ",
                             "dimension 2", "valid: it can be adapted"})
      EXPECT_TRUE(contains(info, part)) << mesh << "\n" << info;
    const std::string json = folder_.run("info --json /dev/stdout " + mesh).out;
    const std::size_t at = info.find("(wall): ") + 8;
    const std::string walls = info.substr(at, info.find_first_of(",\n", at) - at);
    for (const std::string& part : std::vector<std::string>{
             R"({"name": "corner", "dimension": 0, "reference": 3, "count": 1})",
             R"({"name": "wall", "dimension": 1, "reference": 5, "count": )" + walls +
                 R"(, "size": )",
             R"({"name": "steel", "dimension": 2, "reference": 10, "count": )",
             R"({"name": "soft rubber", "dimension": 2, "reference": 20, "count": )"})
      EXPECT_TRUE(contains(json, part)) << part << mesh << "\n" << json;
  }

  Folder folder_;
};

TEST_F(FormatsCommand, AdaptKeepsNamesInEveryFormatThatHoldsThem) {
  for (const std::string output : {"out.vtu", "out.vtk", "out.msh"}) {
    expect_done(folder_, "adapt part.msh -hsiz .1 -v 0 -o " + output);
    EXPECT_EQ(folder_.file_count(), 2U) << output;  // the metric is in it
    expect_names(output);
    // The file is therefore adapted to that metric without a message, and has it if named as -sol,
    // too.
    expect_done(folder_, "adapt " + output + " -o again.msh -v 1");
    expect_done(folder_, "info " + output + " -sol " + output);
    for (const std::string& name : {std::string("again.msh"), output})
      std::filesystem::remove(folder_.path() / name);
  }
  expect_done(folder_, "adapt part.msh -hsiz .2 -v 0 --no-metric");
  expect_names("part.o.msh");
  EXPECT_FALSE(contains(folder_.read("part.o.msh"), "NodeData"));
  EXPECT_TRUE(
      contains(folder_.run("adapt part.msh -hsiz .2 -v 1 -o part.mesh").err, "no place for names"));
}

TEST_F(FormatsCommand, MetricsAndFieldsMayBeInThem) {
  expect_done(folder_, "metric implied part.msh -o sizes.vtu -v 0");
  expect_done(folder_, "metric bound part.msh sizes.vtu -hmax .1 -o fine.sol -v 0");
  expect_done(folder_, "metric bound part.msh sizes.vtu -hmax .1 -o fine.msh -v 0");
  expect_done(folder_, "adapt part.msh -sol fine.msh -v 0 -o a.meshb");
  expect_done(folder_, "adapt part.msh -sol fine.sol -v 0 -o b.meshb");
  EXPECT_EQ(folder_.read("a.meshb"), folder_.read("b.meshb"));
  expect_done(folder_, "adapt part.msh -hsiz .2 --field sizes.vtu -v 0 -o carried.vtk");
  EXPECT_TRUE(contains(folder_.read("carried.vtk"), "sizes 9 "));
  EXPECT_TRUE(contains(folder_.run("adapt carried.vtk -hsiz .3 -o d.vtu").err,
                       "carried.vtk: its fields are not carried: sizes"));
  expect_done(folder_, "convert fine.msh again.sol");
  EXPECT_TRUE(contains(folder_.read("again.sol"), "SolAtVertices"));
  EXPECT_TRUE(contains(folder_.run("metric bound part.msh part.msh -hmax 1 -o c.sol").err,
                       "part.msh: expected a field 'metric'"));
}

TEST_F(FormatsCommand, ConvertGoesFromEachToEach) {
  for (const std::string from : {"part.msh", "a.vtu", "a.vtk"}) {
    for (const std::string to : {"a.vtu", "a.vtk", "b.msh"}) {
      if (to == from) continue;
      expect_done(folder_, "convert " + from + " " + to);
      expect_names(to);
    }
    EXPECT_EQ(folder_.run("convert " + from + " b.meshb").status, 0);
    EXPECT_EQ(folder_.run("convert " + from + " b.su2").status, 0);
    EXPECT_TRUE(contains(folder_.read("b.su2"), "MARKER_TAG= wall"));
  }
  expect_done(folder_, "convert part.msh c.msh --version-of-file 2 --binary");
  EXPECT_TRUE(folder_.read("c.msh").starts_with("$MeshFormat\n2.2 1 8\n"));
  expect_names("c.msh");
  expect_done(folder_, "view a.vtu -o a.svg");
  EXPECT_EQ(folder_.run("convert part.msh a.stl").status, 2);
}

TEST_F(FormatsCommand, FieldsKeepTheirNamesFromFileToFile) {
  expect_done(folder_, "adapt part.msh -hsiz .1 -v 0 -o a.vtu");
  EXPECT_EQ(folder_.run("convert a.vtu plain.meshb").status, 0);
  for (const std::string from : {"a.vtu", "b.vtk", "b.msh"})
    for (const std::string to : {"b.vtu", "b.vtk", "b.msh"}) {
      if (from == to) continue;
      expect_done(folder_, "convert plain.meshb " + to + " -sol " + from);
      expect_done(folder_, "view " + to + " --by metric -o b.png");  // found by its name
    }
}

TEST_F(FormatsCommand, PipesAreCalledMinus) {
  const auto out_of = [&](const std::string& words) {
    const Outcome outcome = folder_.run(words);
    EXPECT_EQ(outcome.status, 0) << words << "\n" << outcome.err;
    return outcome.out;
  };
  expect_done(folder_, "adapt part.msh -hsiz .2 -v 0 -o a.vtu");
  EXPECT_TRUE(out_of("adapt - -hsiz .2 -o -.vtu < part.msh") == folder_.read("a.vtu"));
  EXPECT_TRUE(out_of("adapt - -hsiz .2 -o - < a.vtu").starts_with("MeshVersionFormatted"));
  folder_.write("c.msh", out_of("convert - -.msh < part.msh"));
  expect_names("- < c.msh");
  EXPECT_TRUE(contains(out_of("convert a.vtu -.sol"), "SolAtVertices"));
  for (const char* words : {"adapt - -hsiz .2 < part.msh", "adapt - -o - --field a.sol < part.msh",
                            "adapt part.msh -o -.xyz"})
    EXPECT_EQ(folder_.run(words).status, 2) << words;
}

}  // namespace
}  // namespace ductile::cli::formats_command_test
