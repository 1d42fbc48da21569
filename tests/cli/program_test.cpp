#include "program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "ductile/meshadapt/any_mesh.hpp"
#include "extents.hpp"

namespace ductile::cli::program_test {
namespace {

using meshadapt::AnyMesh;
using meshadapt::Side;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Program, ShowsItsCommandsAndVersion) {
  const Folder folder;
  EXPECT_EQ(folder.run("").status, 2);
  EXPECT_EQ(folder.run("--version").out.rfind("ductile ", 0), 0U);
  const Outcome help = folder.run("help");
  EXPECT_EQ(help.status, 0);
  for (const char* command : {"adapt", "info", "metric", "move", "transfer", "view", "convert"}) {
    EXPECT_TRUE(contains(help.out, command));
    EXPECT_EQ(folder.run(std::string("help ") + command).status, 0);
    EXPECT_EQ(folder.run(std::string(command) + " --help").status, 0);
  }
}

TEST(Program, SuggestsOptionsOnlyWhereTheyAreClose) {
  const Folder folder;
  for (const char* word : {"--foo", "-nr", "-in", "-val", "-x", "-ab"}) {
    const Outcome outcome = folder.run(std::string("adapt a.mesh ") + word);
    EXPECT_EQ(outcome.status, 2) << word;
    EXPECT_FALSE(contains(outcome.err, "did you mean")) << outcome.err;
  }
}

TEST(Program, InfoWarnsOfBoundariesThatCross) {
  const Folder folder;
  const auto info = [&](const char* tip) {  // edits the first of two triangles
    folder.write("m.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices 6\n0 0 0\n0 1 0\n" +
                               std::string(tip) +
                               " 0.4 0\n1 0 0\n2 0 0\n1 1 0\n"
                               "Triangles 2\n1 3 2 1\n4 5 6 1\n"
                               "Edges 6\n1 2 1\n2 3 1\n3 1 1\n4 5 1\n5 6 1\n6 4 1\nEnd\n");
    return folder.run("info m.mesh");
  };
  const Outcome apart = info("0.9"), crossing = info("1.1");
  EXPECT_EQ(apart.status, 0);
  EXPECT_EQ(apart.err, "");
  EXPECT_EQ(crossing.status, 0);
  EXPECT_TRUE(contains(crossing.err, "m.mesh: edge 2 crosses edge 6")) << crossing.err;
}

TEST(Program, SaysWhichMeshCannotBeDrawnAndWhatToDo) {
  const Folder folder;
  const std::string head = "MeshVersionFormatted 2\nDimension 2\nVertices 3\n";
  folder.write("bare.mesh", head + "0 0 0\n1 0 0\n0 1 0\nEnd\n");
  folder.write("vast.mesh", head + "-1e308 0 0\n1e308 0 0\n0 1 0\nTriangles 1\n1 2 3 1\nEnd\n");
  const Outcome bare = folder.run("view bare.mesh"), vast = folder.run("view vast.mesh");
  EXPECT_EQ(bare.status, 2);
  EXPECT_TRUE(contains(bare.err,
                       "bare.mesh: expected triangles or tetrahedra to draw, found "
                       "neither\n  give a mesh"))
      << bare.err;
  EXPECT_EQ(vast.status, 2);
  EXPECT_TRUE(contains(vast.err, "vast.mesh: ")) << vast.err;
  EXPECT_TRUE(contains(vast.err, "scale the mesh")) << vast.err;
}

TEST(Program, TellsWhatIsWrongWithACommandLine) {
  const Folder folder;
  const auto expect = [&](const char* words, const char* part) {
    const Outcome outcome = folder.run(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, part)) << words << ": " << outcome.err;
    EXPECT_EQ(outcome.out, "") << words;
  };
  expect("adpat", "did you mean 'adapt'");
  expect("adapt a.mesh -hmn 1", "did you mean -hmin?");
  expect("adapt a.mesh --itertions 1", "did you mean --iterations?");
  expect("adapt a.mesh -hzis 1", "did you mean -hsiz?");
  for (const char* refused : {"3dMedit", "nreg", "nsd", "optimLES", "xreg"})
    expect(("adapt a.mesh -" + std::string(refused) + " 1").c_str(),
           ("unknown option -" + std::string(refused) + "\n  Mmg's, not here: ").c_str());
  expect("adapt a.mesh -in b.mesh", "expected one mesh, found 2");
  expect("adapt a.mesh -optim -hsiz 1", "options -optim and -hsiz: expected one of them");
  expect("adapt a.mesh -optim -sol a.sol", "options -optim and -sol: expected one of them");
  expect("info a.mesh -nofem", "unknown option -nofem\n  Mmg's: ductile adapt takes it");
  expect("adapt a.mesh -hmin", "expected X after it, found nothing");
  expect("adapt a.mesh -hmin -hmax 1", "expected X after it, found nothing");
  expect("adapt a.mesh -hmin zero", "a number above 0, found 'zero'");
  expect("adapt a.mesh -hmin -1", "a number above 0, found '-1'");
  expect("adapt a.mesh -hmin nan", "found 'nan'");
  expect("adapt a.mesh -hmin 2 -hmax 1", "-hmin to be the smaller");
  expect("adapt a.mesh -hgrad 0.5", "1 or more");
  expect("adapt a.mesh -hgradreq 0.5", "1 or more");
  expect("adapt a.mesh --threads 0", "a whole number from 1");
  expect("adapt a.mesh --threads 1.5", "a whole number from 1");
  expect("adapt a.mesh --racing=yes", "takes no value");
  expect("adapt a.mesh -sol a.sol -hsiz 1", "expected one of them");
  expect("adapt", "expected one mesh, found 0");
  expect("adapt a.mesh b.mesh", "expected one mesh, found 2\n  -o says where");
  expect("adapt a.mesh -o b.xyz", "ending in .mesh, .meshb");
  expect("view a.mesh -o b.gif", "ending in .png, .svg or .html");
  expect("view a.mesh --cut w", "x, y or z");
  expect("convert a.mesh", "expected an input and an output");
  expect("convert a.mesh a.sol", "as the input is a mesh");
}

TEST(Program, TellsWhichFileIsMissing) {
  const Folder folder;
  for (const char* words :
       {"adapt none.mesh", "info none.mesh", "view none.mesh", "convert none.mesh out.meshb"}) {
    const Outcome outcome = folder.run(words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_TRUE(contains(outcome.err, "none.mesh")) << outcome.err;
    EXPECT_TRUE(tells_one_error(outcome.err)) << outcome.err;
  }
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Info, CountsAndMeasures) {
  const Folder folder;
  folder.add_example("waves3d");
  const Outcome outcome = folder.run("info waves3d.mesh -sol waves3d.sol --json info.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"dimension 3", "1,331", "6,000", "valid", "quality", "[0.71, 1.41]"})
    EXPECT_TRUE(contains(outcome.out, part)) << part << "\n" << outcome.out;
  EXPECT_TRUE(contains(folder.read("info.json"), "\"tetrahedra\": 6000"));
  EXPECT_TRUE(contains(folder.read("info.json"), "\"volume\": "));
  EXPECT_FALSE(contains(outcome.out, " 0.00 %")) << outcome.out;
}

TEST(Info, TellsSizesByReference) {
  for (const int dimension : {2, 3}) {
    AnyMesh mesh = dimension == 2 ? meshadapt::box_mesh<2>({3, 2}, {6, 4})
                                  : meshadapt::box_mesh<3>({3, 2, 1}, {6, 4, 2});
    auto& reference = dimension == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
    for (std::size_t e = 0; e < reference.size(); e += 3) reference[e] = 4;
    const Extents found = extents_of(mesh);
    EXPECT_EQ(found.box.low.x, (std::array<double, 3>{}));
    EXPECT_EQ(found.box.high.x, (std::array<double, 3>{3, 2, dimension == 2 ? 0.0 : 1.0}));
    const auto cells = static_cast<std::size_t>(dimension), facets = cells - 1;
    EXPECT_NEAR(found.total(cells).size, 6, 1e-12);
    EXPECT_EQ(found.total(cells).count, reference.size());
    EXPECT_NEAR(found.total(facets).size, dimension == 2 ? 10 : 22, 1e-12);
    EXPECT_NEAR(found.amount_of[cells].at(4).size, 2, 1e-12);
    EXPECT_NEAR(found.amount_of[facets].at(Side::left).size, 2, 1e-12);
    EXPECT_NEAR(found.amount_of[facets].at(Side::top).size, 3, 1e-12);
    EXPECT_NEAR(found.smallest_angle, 45, 1e-9);
    EXPECT_NEAR(found.largest_angle, 90, 1e-9);
  }
  AnyMesh regular;  // its angles are all arccos(1/3)
  regular.dimension = 3;
  regular.coordinates = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
  regular.vertex_reference = {0, 0, 0, 0};
  regular.tetrahedra.add({0, 1, 2, 3}, 1);
  EXPECT_NEAR(extents_of(regular).smallest_angle, 70.528779365509308, 1e-9);
  EXPECT_NEAR(extents_of(regular).largest_angle, 70.528779365509308, 1e-9);
}

TEST(Info, SaysWhyAMeshIsNotValid) {
  const Folder folder;
  folder.write("flat.mesh",
               "MeshVersionFormatted 2\nDimension 2\nVertices\n3\n0 0 0\n1 0 0\n2 0 0\n"
               "Triangles\n1\n1 2 3 1\nEnd\n");
  const Outcome outcome = folder.run("info flat.mesh");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.out, "not valid")) << outcome.out;
}

TEST(Info, SaysWhatAdaptSaysOfLengthsBeyondReason) {
  const Folder folder;
  for (const auto& [length, reason] :
       std::map<std::string, std::string>{{"1e60", "a.mesh: vertex 2 has a coordinate beyond 1e50"},
                                          {"1e-60", "a.mesh: the mesh is smaller than 1e-50"}}) {
    std::string text = "MeshVersionFormatted 2\nDimension 2\nVertices\n3\n0 0 0\n";
    text.append(length).append(" 0 0\n0 ").append(length).append(" 0\n");
    text += "Edges\n3\n1 2 1\n2 3 1\n3 1 1\nTriangles\n1\n1 2 3 1\nEnd\n";
    folder.write("a.mesh", text);
    const Outcome told = folder.run("info a.mesh"), refused = folder.run("adapt a.mesh");
    EXPECT_EQ(told.status, 2) << told.out;
    EXPECT_TRUE(contains(told.out, "not valid: " + reason)) << told.out;
    EXPECT_EQ(refused.status, 2);
    EXPECT_TRUE(contains(refused.err, reason)) << refused.err;
  }
}

TEST(Info, RefusesTheMetricOfAnotherMesh) {
  const Folder folder;
  folder.add_example("waves2d");
  folder.add_example("waves3d");
  EXPECT_EQ(folder.run("info waves2d.mesh -sol waves3d.sol").status, 2);
}

TEST(View, DrawsBothDimensionsInBothFormats) {
  const Folder folder;
  for (const char* name : {"waves2d", "waves3d"}) {
    folder.add_example(name);
    const std::string mesh = std::string(name) + ".mesh";
    const std::string svg = mesh + " -sol " + name + ".sol -o p.svg --size 200";
    for (const char* by : {"quality", "size", "reference", "metric", "1", "1:2", name})
      EXPECT_EQ(folder.run("view " + mesh + " --size 200 --by " + by).status, 0) << by;
    EXPECT_EQ(folder.read(std::string(name) + ".png").substr(1, 3), "PNG");
    EXPECT_EQ(folder.run("view " + svg).status, 0);
    EXPECT_TRUE(contains(folder.read("p.svg"), "<svg"));
  }
}

TEST(View, FindsFieldsWhereTheyAre) {
  const Folder folder;
  folder.add_example("waves2d");
  EXPECT_EQ(folder.run("convert waves2d.mesh a.vtu -sol waves2d.sol").status, 0);
  std::filesystem::remove(folder.path() / "waves2d.sol");
  const auto picture = [&](const std::string& words) {
    const Outcome outcome = folder.run("view " + words + " --size 200 -o p.svg");
    EXPECT_EQ(outcome.status, 0) << words << outcome.err;
    return folder.read("p.svg");
  };
  EXPECT_TRUE(picture("a.vtu --by 1") == picture("a.vtu --by waves2d"));
  EXPECT_FALSE(picture("a.vtu --by 1") == picture("a.vtu --by 1:3"));
  EXPECT_FALSE(picture("a.vtu --by metric -sol a.vtu") == picture("a.vtu"));
  const auto refusal = [&](const std::string& words) {
    const Outcome outcome = folder.run("view " + words);
    EXPECT_EQ(outcome.status, 2) << words;
    return outcome.err;
  };
  EXPECT_TRUE(contains(refusal("a.vtu --by colour"),
                       "option --by: expected quality, size, reference, metric or a field, by name "
                       "or number, found 'colour'\n  a.vtu has 1 waves2d"));
  EXPECT_TRUE(contains(refusal("waves2d.mesh --by 1"), "waves2d.mesh has no fields"));
  EXPECT_TRUE(contains(refusal("waves2d.mesh --by metric"), "expected a metric (-sol)"));
  EXPECT_TRUE(contains(refusal("waves2d.mesh -sol none.sol --by 1"), "none.sol: "));
}

TEST(Convert, GoesThereAndBack) {
  const Folder folder;
  folder.add_example("waves3d");
  EXPECT_EQ(folder.run("convert waves3d.mesh a.meshb").status, 0);
  EXPECT_EQ(folder.run("convert waves3d.sol a.solb").status, 0);
  EXPECT_EQ(folder.run("convert a.meshb b.meshb --version-of-file 4").status, 0);
  EXPECT_EQ(folder.run("convert b.meshb c.meshb").status, 0);
  EXPECT_EQ(folder.read("a.meshb"), folder.read("c.meshb"));
  EXPECT_EQ(folder.run("convert a.meshb a.vtu -sol a.solb").status, 0);
  EXPECT_TRUE(contains(folder.read("a.vtu"), "UnstructuredGrid"));
}

TEST(Convert, RefusesWhatItWouldIgnore) {
  const Folder folder;
  folder.add_example("waves2d");
  folder.add_example("waves3d");
  for (const char* words : {"convert waves2d.mesh a.meshb -sol waves2d.sol",
                            "convert waves2d.sol a.solb -sol waves2d.sol",
                            "convert waves2d.mesh a.vtu --version-of-file 3",
                            "convert waves2d.mesh a.vtu -sol waves3d.sol"}) {
    const Outcome outcome = folder.run(words);
    EXPECT_EQ(outcome.status, 2) << words << ": " << outcome.err;
  }
  EXPECT_FALSE(folder.has("a.meshb") || folder.has("a.solb") || folder.has("a.vtu"));
}

TEST(Convert, RoundsNoNumbers) {
  const Folder folder;
  folder.add_example("waves2d");
  for (const char* words : {"waves2d.sol a.solb", "waves2d.mesh a.meshb"}) {
    const Outcome refused = folder.run("convert " + std::string(words) + " --version-of-file 1");
    EXPECT_EQ(refused.status, 2);
    EXPECT_TRUE(contains(refused.err, "version 1 hold 7 digits")) << refused.err;
    EXPECT_EQ(folder.run("convert " + std::string(words) + " --version-of-file 2").err, "");
  }
  EXPECT_EQ(folder.run("convert waves2d.sol b.sol --version-of-file 1").status, 0);
}

TEST(Program, WritesToAStandardOutputThatIsAFileBesideWhatItSays) {
  const Folder folder;
  folder.add_example("waves2d");
  const Outcome told = folder.run("info waves2d.mesh --json /dev/stdout");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_TRUE(contains(told.out, "valid: it can be adapted")) << told.out;
  EXPECT_TRUE(contains(told.out, "\"statistics\"")) << told.out;
}

TEST(Program, TakesAnyBytesInNames) {
  const Folder folder;
  folder.add_example("waves2d");
  ASSERT_EQ(folder.run("convert waves2d.mesh 'l\xe4.mesh'").status, 0);
  const Outcome told = folder.run("info 'l\xe4.mesh' --json /dev/stdout | tail -n +1");
  EXPECT_TRUE(contains(told.out, "l?.mesh")) << told.out << told.err;
  EXPECT_EQ(folder.run("view 'l\xe4.mesh' -o a.svg").status, 0);
}

}  // namespace
}  // namespace ductile::cli::program_test
