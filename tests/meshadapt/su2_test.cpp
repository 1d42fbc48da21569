/// @file
/// SU2 meshes: files are read back as written, files of SU2 and mesh generators are read, and
/// faults are reported with their line.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::su2_test {
namespace {

AnyMesh read_text(const std::string& text, Warnings* warnings = nullptr) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a.su2", text);
  AnyMesh mesh = read_mesh(folder / "a.su2", warnings);
  mesh.name.clear();
  return mesh;
}

/// A square of two triangles with two markers.
AnyMesh square() {
  AnyMesh mesh;
  mesh.dimension = 2;
  mesh.coordinates = {0, 0, 1, 0, 1, 1, 0, 1};
  mesh.vertex_reference.assign(4, 0);
  mesh.triangles.add({0, 1, 2}, 0);
  mesh.triangles.add({0, 2, 3}, 0);
  mesh.edges.add({0, 1}, 1);
  mesh.edges.add({1, 2}, 2);
  mesh.edges.add({2, 3}, 2);
  mesh.edges.add({3, 0}, 2);
  mesh.names = {{1, 1, "wall"}, {1, 2, "far-field"}};
  return mesh;
}

// ---- Files that are written are read ----

/// Facets with the names of their markers, which determine the order in the file.
template <int Corners>
std::multiset<std::pair<std::string, std::array<std::uint32_t, Corners>>> marked(
    const AnyMesh& mesh, const Cells<Corners>& facets) {
  std::map<std::int32_t, std::string> name_of;
  for (const ReferenceName& name : mesh.names)
    if (name.dimension == mesh.dimension - 1) name_of[name.reference] = name.name;
  std::multiset<std::pair<std::string, std::array<std::uint32_t, Corners>>> result;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const auto name = name_of.find(facets.reference[i]);
    result.emplace(name == name_of.end() ? std::to_string(facets.reference[i]) : name->second,
                   facets.vertices[i]);
  }
  return result;
}

TEST(Su2, IsReadAsItWasWritten) {
  const test::TemporaryFolder folder;
  unsigned seed = 0;
  for (const int dimension : {2, 3})
    for (const std::size_t size : {1U, 2U, 17U, 300U}) {
      SCOPED_TRACE(std::to_string(dimension) + " " + std::to_string(size));
      AnyMesh mesh = test::random_mesh(dimension, size, ++seed);
      auto& facets = dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
      for (std::size_t i = 0; i < facets.size(); ++i)
        facets[i] = static_cast<std::int32_t>(i % 5) - 2;
      mesh.names = {{dimension - 1, 2, "wall"}, {dimension - 1, -1, "inlet_1"}};
      write_mesh(folder / "a.su2", mesh);
      Warnings warnings;
      const AnyMesh found = read_mesh(folder / "a.su2", &warnings);
      EXPECT_EQ(warnings, Warnings{});
      EXPECT_EQ(found.dimension, dimension);
      ASSERT_EQ(found.coordinates.size(), mesh.coordinates.size());
      EXPECT_EQ(std::memcmp(found.coordinates.data(), mesh.coordinates.data(),
                            8 * mesh.coordinates.size()),
                0);
      if (dimension == 2) {
        EXPECT_EQ(found.triangles.vertices, mesh.triangles.vertices);
        EXPECT_EQ(marked(found, found.edges), marked(mesh, mesh.edges));
      } else {
        EXPECT_EQ(found.tetrahedra.vertices, mesh.tetrahedra.vertices);
        EXPECT_EQ(marked(found, found.triangles), marked(mesh, mesh.triangles));
      }
    }
}

// ---- Files of other programs ----

TEST(Su2, IsReadAsMeshGeneratorsWriteIt) {
  const std::string rows = "5 0 1 2 0\n5 0 2 3 1\n";  // numbered, as older programs write
  const std::string points = "0 0 0\n1 0 1\n1 1 2\n0 1 3\n";
  const std::string markers =
      "NMARK= 2\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n3 0 1\n"
      "MARKER_TAG= far-field\nMARKER_ELEMS= 3\n3 1 2\n3 2 3\n3 3 0\n";
  const std::string elements_first =
      "NDIME= 2\nNELEM= 2\n" + rows + "NPOIN= 4\n" + points + markers;
  const std::string points_first =
      "% a wing\n\nNZONE=1\nIZONE= 1\n  NDIME =2  % plane\nNPOIN= 4 4\n% x y\n" + points +
      "\n\nNELEM= 2\n5\t0 1 2\n%\n  5 0 2 3\n" + markers;
  std::string with_returns;
  for (const char c : points_first) with_returns += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& text : {elements_first, points_first, with_returns,
                                  elements_first.substr(0, elements_first.size() - 1)}) {
    Warnings warnings;
    EXPECT_EQ(read_text(text, &warnings), square()) << text;
    EXPECT_EQ(warnings, Warnings{});
  }
  Warnings warnings;
  EXPECT_EQ(read_text("NDIME= 2\nAOA= 3\nNELEM= 2\n" + rows + "NPOIN= 4\n" + points + markers +
                          "FFD_NBOX= 1\nFFD_TAG= box\nFFD_CORNER_POINTS= 2\n0 0\n1 1\n",
                      &warnings),
            square());
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("a.su2:2: sections that Ductile does not use are left out: AOA, "
                             "FFD_NBOX, FFD_TAG, FFD_CORNER_POINTS"),
            std::string::npos)
      << warnings[0];
}

TEST(Su2, MarkersThatAreNumbersAreReferences) {
  const std::string mesh = "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\nNMARK= 3\n";
  const AnyMesh found = read_text(mesh +
                                  "MARKER_TAG= wall\nMARKER_ELEMS= 1\n3 0 1\n"
                                  "MARKER_TAG= 1\nMARKER_ELEMS= 1\n3 1 2\n"
                                  "MARKER_TAG= inlet\nMARKER_ELEMS= 1\n3 2 0\n");
  EXPECT_EQ(found.edges.reference, (std::vector<std::int32_t>{2, 1, 3}));
  EXPECT_EQ(found.names, (std::vector<ReferenceName>{{1, 2, "wall"}, {1, 3, "inlet"}}));
}

TEST(Su2, TrianglesInAPlaneOfSpaceAreAMeshOfDimension2) {
  const std::array<const char*, 3> points = {"7 0 0\n7 1 0\n7 0 1\n", "0 7 0\n1 7 0\n0 7 1\n",
                                             "0 0 7\n1 0 7\n0 1 7\n"};
  for (int axis = 0; axis < 3; ++axis) {
    const AnyMesh found = read_text("NDIME= 3\nNELEM= 0\nNPOIN= 3\n" + std::string(points[axis]) +
                                    "NMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 1 2\n");
    EXPECT_EQ(found.dimension, 2);
    EXPECT_EQ(found.dropped_axis, axis);
    EXPECT_EQ(found.coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(found.names, (std::vector<ReferenceName>{{2, 1, "wall"}}));
  }
}

// ---- Invalid files ----

TEST(Su2, ComplainsWithTheLine) {
  const std::string head = "NDIME= 2\n", cells = "NELEM= 1\n5 0 1 2\n",
                    points = "NPOIN= 3\n0 0\n1 0\n0 1\n",
                    marker = "MARKER_TAG= a\nMARKER_ELEMS= 1\n3 0 1\n";
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"NDIME= 4\n", "a.su2:1: expected dimension 2 or 3, found 4"},
      {"NDIME= two\n", "a.su2:1: expected a number behind NDIME=, found 'two'"},
      {head + head, "a.su2:2: expected one NDIME="},
      {cells + points, "a.su2:1: expected NDIME= before NELEM="},
      {"NZONE= 2\n" + head, "a.su2:1: expected one zone, found 2"},
      {head + "NELEM= 2\n5 0 1 2\n" + points, "expected the type of an element"},
      {head + "NELEM= 1\n9 0 1 2 3\n", "a.su2:3: expected a triangle (type 5), found type 9"},
      {head + "NELEM= 1\n5 0 1\n" + points, "a.su2:3: expected a point, from 0, found the end of"},
      {head + "NELEM= 1\n5 0 1 -2\n", "a.su2:3: expected a point, from 0"},
      {head + "NELEM= 99999999999\n5 0 1 2\n", "found a count of 99999999999"},
      {head + "NELEM= 1\n5 0 1 3\n" + points, "expected points from 0 to 2, found 3 in triangle 1"},
      {head + cells + points + cells, "a.su2:8: expected one NELEM="},
      {head + cells + points + "4 5\n", "a.su2:8: expected a keyword such as NPOIN=, found '4 5'"},
      {head + cells + "NPOIN= 3\n0.5 0.5\n1\n0.5 1.5\n",
       "a.su2:6: expected a coordinate, found the end"},
      {head + cells + "NPOIN= 3\n0 0\n1 nan\n0 1\n", "a.su2:6: expected a finite coordinate"},
      {head + cells + "NPOIN= 3\n0 0\n1 0\n% no more\n", "expected a point, found the end of"},
      {head + cells, "expected NPOIN=, found none"},
      {head + points, "expected NELEM=, found none"},
      {head + cells + points + "MARKER_ELEMS= 1\n3 0 1\n", "expected MARKER_TAG= before"},
      {head + cells + points + "MARKER_TAG=\n", "a.su2:8: expected the name of a marker"},
      {head + cells + points + "NMARK= 2\n" + marker, "expected 2 markers, by NMARK=, found 1"},
      {head + cells + points + "MARKER_TAG= a\nMARKER_ELEMS= 1\n5 0 1 2\n", "expected a line"},
  };
  for (const auto& [text, message] : wrong) {
    const std::string found = test::complaint([&text = text] { read_text(text); });
    EXPECT_NE(found.find(message), std::string::npos) << text << found;
  }
}

}  // namespace
}  // namespace ductile::meshadapt::su2_test
