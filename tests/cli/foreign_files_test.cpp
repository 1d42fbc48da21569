// Files written by other programs and users, processed by the whole program.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "program.hpp"

namespace ductile::cli::foreign_files_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

/// A unit square of n x n cells, cut into triangles; the seed decides random choices.
class Square {
 public:
  Square(int n, unsigned seed) : n_(n), random_(seed) {}

  std::string vertices(const char* third = "") {
    std::string text = "Vertices\n" + std::to_string((n_ + 1) * (n_ + 1)) + "\n";
    for (int i = 0; i <= n_; ++i)
      for (int j = 0; j <= n_; ++j)
        text += std::to_string(1.0 * i / n_) + " " + std::to_string(1.0 * j / n_) + " " + third +
                " 0\n";
    return text;
  }

  /// Triangles of the cells; with `turn`, some are inverted.
  std::string triangles(bool turn = false) {
    std::string text = "Triangles\n" + std::to_string(2 * n_ * n_) + "\n";
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j) {
        text += row({number(i, j), number(i + 1, j), number(i + 1, j + 1)}, turn);
        text += row({number(i, j), number(i + 1, j + 1), number(i, j + 1)}, turn);
      }
    return text;
  }

  /// Boundary edges, each listed `times` times, in either direction.
  std::string edges(int times = 1) {
    std::string text = "Edges\n" + std::to_string(4 * n_ * times) + "\n";
    for (int time = 0; time < times; ++time)
      for (int i = 0; i < n_; ++i) {
        text += row({number(i, 0), number(i + 1, 0)}, times > 1);
        text += row({number(i, n_), number(i + 1, n_)}, times > 1);
        text += row({number(0, i), number(0, i + 1)}, times > 1);
        text += row({number(n_, i), number(n_, i + 1)}, times > 1);
      }
    return text;
  }

 private:
  int number(int i, int j) const { return i * (n_ + 1) + j + 1; }
  std::string row(std::vector<int> corners, bool turn) {
    if (turn && random_() % 3 == 0) std::swap(corners[0], corners[1]);
    std::string text;
    for (const int corner : corners) text += std::to_string(corner) + " ";
    return text + "1\n";
  }

  int n_;
  std::mt19937_64 random_;
};

void expect_adapted_with(const Folder& folder, const std::string& warning) {
  const Outcome outcome = folder.run("adapt a.mesh -hsiz 0.2 -o o.mesh");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(lines(outcome.err), 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, warning)) << outcome.err;
  EXPECT_EQ(folder.run("info o.mesh").status, 0);
  EXPECT_EQ(folder.run("info a.mesh").status, 0);
}

TEST(ForeignFiles, OfBamgAreAdapted) {
  const Folder folder;
  Square square(4, 1);
  folder.write("a.mesh",
               "MeshVersionFormatted 0\n\nDimension\n2\n\nIdentifier\n\"G=g.mesh;1, Date: 15s\"\n\n"
               "Geometry\n\"g.mesh\"\n\n" +
                   square.vertices() + "\n" + square.edges() + "\n" + square.triangles() +
                   "\nSubDomainFromMesh\n1\n3 1 1 1\n\nVertexOnGeometricVertex\n1\n 1 1\n\nEnd\n");
  expect_adapted_with(folder,
                      "a.mesh:6: sections that Ductile does not use are left out: Identifier, "
                      "Geometry, SubDomainFromMesh, VertexOnGeometricVertex");
}

TEST(ForeignFiles, WithEdgesAndTrianglesInAnyOrderAreAdapted) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Folder folder;
    Square square(3 + static_cast<int>(seed % 3), seed);
    const std::string head = "MeshVersionFormatted 2\nDimension 2\n" + square.vertices();
    folder.write("a.mesh", head + square.edges(2 + static_cast<int>(seed % 2)) +
                               square.triangles() + "End\n");
    expect_adapted_with(folder, "listed edges were listed before and are merged");
    folder.write("a.mesh", head + square.edges() + square.triangles(true) + "End\n");
    expect_adapted_with(folder, "elements were listed the other way round and have been turned");
  }
}

TEST(ForeignFiles, InSpaceButFlatAreAdapted) {
  for (const char* height : {"0", "1e-17", "3.25", "-1e5"}) {
    const Folder folder;
    Square square(3, 0);
    std::string vertices = square.vertices(height);
    if (std::string(height) == "1e-17") vertices.replace(vertices.rfind("1e-17"), 5, "-2e-9");
    folder.write("a.mesh", "MeshVersionFormatted 2\nDimension 3\n" + vertices + square.edges() +
                               square.triangles() + "End\n");
    expect_adapted_with(folder, "taken as a mesh of dimension 2");
  }
}

TEST(ForeignFiles, MayAskForNoLimitWhereOneIsGiven) {
  const Folder folder;
  Square square(3, 0);
  folder.write("a.mesh", "MeshVersionFormatted 2\nDimension 2\n" + square.vertices() +
                             square.edges() + square.triangles() + "End\n");
  const auto field = [&](const char* type, const char* usual, const char* odd) {
    std::string text =
        "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n16\n1 " + std::string(type) + "\n";
    for (int v = 0; v < 16; ++v) text += std::string(v % 3 ? usual : odd) + "\n";
    folder.write("a.sol", text + "End\n");
  };
  const struct {
    const char *type, *usual, *odd;
  } fields[] = {{"1", "0.2", "inf"},        {"1", "0.2", "1e300"},     {"1", "0.2", "1e400"},
                {"3", "25 0 25", "25 0 0"}, {"3", "25 0 25", "0 0 0"}, {"3", "25 0 25", "9 9 9"}};
  for (const auto& [type, usual, odd] : fields) {
    SCOPED_TRACE(odd);
    field(type, usual, odd);
    EXPECT_EQ(folder.run("adapt a.mesh -o o.mesh").status, 2);
    EXPECT_EQ(folder.run("adapt a.mesh -hmin 0.01 -o o.mesh").status, 2);
    const Outcome outcome = folder.run("adapt a.mesh -hmin 0.01 -hmax 0.3 -o o.mesh");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const Outcome bound = folder.run("metric bound a.mesh a.sol -hmax 0.3 -o b.sol");
    EXPECT_EQ(bound.status, 0) << bound.err;
    EXPECT_EQ(folder.run("adapt a.mesh -sol b.sol -o o.mesh").status, 0);
  }
}

TEST(ForeignFiles, WithControlCharactersInTheirNamesAreToldInOneLine) {
  const Folder folder;
  const Outcome missing = folder.run("info \"$(printf 'a\\nb\\033[31m.mesh')\"");
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(tells_one_error(missing.err)) << missing.err;
  EXPECT_TRUE(contains(missing.err, "a\\nb\\x1b[31m.mesh: ")) << missing.err;
  const Outcome option = folder.run("info a.mesh \"$(printf -- '-\\033x\\r')\"");
  EXPECT_TRUE(contains(option.err, "unknown option -\\x1bx\\r")) << option.err;
  folder.add_example("waves2d");
  const Outcome odd = folder.run("adapt waves2d.mesh -hsiz 0.2 -o \"$(printf 'o\\007\\n1.mesh')\"");
  EXPECT_EQ(odd.status, 0) << odd.err;
  EXPECT_TRUE(contains(odd.out, "written: o\\x07\\n1.mesh")) << odd.out;
}

TEST(ForeignFiles, OutputsThatLeadNowhereAreRefusedBeforeTheWork) {
  const Folder folder;
  folder.add_example("waves2d");
  std::filesystem::create_symlink("loop.mesh", folder.path() / "loop.mesh");
  const std::size_t files = folder.file_count();
  for (const std::string& name : {std::string("loop.mesh"), std::string(300, 'n') + ".mesh"}) {
    const Outcome outcome = folder.run("adapt waves2d.mesh -hsiz 0.1 -o " + name);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, ": cannot write, the name is ")) << outcome.err;
  }
  const Outcome field = folder.run("adapt waves2d.mesh -o " + std::string(249, 'n') +
                                   ".mesh --vtu " + std::string(252, 'n') + ".vtu");
  EXPECT_EQ(field.status, 2) << field.err;
  EXPECT_EQ(folder.file_count(), files);
}

}  // namespace
}  // namespace ductile::cli::foreign_files_test
