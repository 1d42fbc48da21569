// GMF files of other programs: unknown content between sections is skipped, with one warning, and
// does not affect the sections that are read.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::foreign_gmf_test {
namespace {

using Form = WriteOptions::Form;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t limit) {
  return static_cast<std::size_t>(random() % limit);
}

template <class List>
const auto& any_of(Random& random, const List& list) {
  return list[below(random, std::size(list))];
}

// ---- Random sections of a text ----

/// A word that is no keyword, nor close to one.
std::string random_name(Random& random) {
  const std::array<std::string, 10> known = {
      "Identifier",          "SubDomainFromMesh",     "VertexOnGeometricVertex",
      "EdgeOnGeometricEdge", "MaximalAngleOfCorner",  "ParallelVertexCommunicators",
      "ParallelVertices",    "MeshSupportOfVertices", "CrackedEdges",
      "TangentAtEdges"};
  if (random() % 2) return any_of(random, known);
  std::string name(1, static_cast<char>('A' + below(random, 26)));
  const std::string letters = "abcdefghijklmnopqrstuvwxyzXYZ0123456789_-";
  for (std::size_t length = 9 + below(random, 30); name.size() < length;)
    name += letters[below(random, letters.size())];
  return name;
}

std::string random_number(Random& random) {
  const std::array<std::string, 8> odd = {"1e300", "-1.5d+3", "+7", ".5", "-0", "3.", "1E5", "007"};
  return random() % 4 == 0 ? any_of(random, odd) : std::to_string(below(random, 100000));
}

std::string random_string(Random& random) {
  const std::array<std::string, 6> strings = {"\"\"",
                                              "\"G=g.mesh;1, Date: 26/11/26 14:00 15s\"",
                                              "\"Vertices 4 # End\"",
                                              "\"Triangles\"",
                                              "\"C:\\a b\\End\"",
                                              "\"never closed"};
  return any_of(random, strings);
}

std::string random_line(Random& random) {
  const std::array<std::string, 6> words = {"made of Triangles by hand",
                                            "The End of it",
                                            "g.mesh Vertices 3",
                                            "(1, 2), 3",
                                            "nan inf 0x1F",
                                            "folder/of/End Triangles 1"};
  std::string line;
  switch (below(random, 6)) {
    case 0:
      return random_string(random);
    case 1:
      return any_of(random, words);
    case 2:
      return "# Vertices 5, a comment";
    default:
      for (std::size_t n = below(random, 7); n > 0; --n) line += " " + random_number(random);
      return line;
  }
}

std::string random_section(Random& random, const std::string& newline) {
  std::string text = random_name(random);
  if (random() % 3) text += (random() % 2 ? newline : " ") + random_number(random);
  if (random() % 4 == 0) text += " " + random_string(random);
  text += newline;
  for (std::size_t lines = below(random, 6); lines > 0; --lines)
    text += random_line(random) + newline;
  return text;
}

/// The parts of a text, each beginning with a keyword.
std::vector<std::string> sections_of(const std::string& text) {
  std::vector<std::string> sections;
  std::size_t begin = 0;
  for (std::size_t at = 1; at <= text.size(); ++at)
    if (at == text.size() || (text[at - 1] == '\n' && text[at] >= 'A' && text[at] <= 'Z')) {
      sections.push_back(text.substr(begin, at - begin));
      begin = at;
    }
  return sections;
}

TEST(ForeignGmf, LeavesOutWhateverIsBetweenSectionsOfAText) {
  const test::TemporaryFolder folder;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    AnyMesh mesh = test::random_mesh(2 + static_cast<int>(seed % 2), 8, seed);
    write_mesh(folder / "a.mesh", mesh, {.form = Form::ascii});
    const std::string newline = seed % 3 == 0 ? "\r\n" : "\n";
    std::string text;
    bool first = true;
    std::size_t added = 0;
    for (const std::string& section : sections_of(test::get_bytes(folder / "a.mesh"))) {
      for (std::size_t n = first ? 0 : below(random, 3); n > 0; --n, ++added)
        text += random_section(random, newline);
      text += section;
      first = false;
    }
    test::put_bytes(folder / "b.mesh", text);
    Warnings warnings;
    AnyMesh back = read_mesh(folder / "b.mesh", &warnings);
    ASSERT_EQ(warnings.size(), added == 0 ? 0U : 1U) << text;
    if (added > 0) {
      EXPECT_NE(warnings[0].find("left out: "), std::string::npos) << warnings[0];
    }
    back.name = mesh.name;
    EXPECT_EQ(back, mesh) << text;
  }
}

// ---- Random sections of a binary file ----

/// Writes and reads numbers in a version and a byte order.
struct Coding {
  int version;
  std::endian order;

  std::size_t link() const { return version >= 3 ? 8 : 4; }

  std::string bytes(std::uint64_t number, std::size_t size) const {
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; ++i)
      text[order == std::endian::little ? i : size - 1 - i] =
          static_cast<char>(number >> (8 * i) & 0xffU);
    return text;
  }
  std::uint64_t number(const std::string& file, std::size_t at, std::size_t size) const {
    std::uint64_t result = 0;
    for (std::size_t i = 0; i < size; ++i)
      result |= std::uint64_t{static_cast<unsigned char>(
                    file[at + (order == std::endian::little ? i : size - 1 - i)])}
                << (8 * i);
    return result;
  }
};

struct BinarySection {
  std::uint64_t keyword = 0;
  std::string payload;
};

std::vector<BinarySection> sections_of(const std::string& file, const Coding& coding) {
  std::vector<BinarySection> sections;
  for (std::size_t at = 8; at + 4 <= file.size();) {
    const std::uint64_t keyword = coding.number(file, at, 4);
    if (keyword == 54) break;
    const auto next = static_cast<std::size_t>(coding.number(file, at + 4, coding.link()));
    const std::size_t begin = at + 4 + coding.link();
    sections.push_back({keyword, file.substr(begin, next - begin)});
    at = next;
  }
  return sections;
}

std::string file_of(const std::string& head, const std::vector<BinarySection>& sections,
                    const Coding& coding) {
  std::string file = head;
  for (const BinarySection& section : sections) {
    const std::size_t next = file.size() + 4 + coding.link() + section.payload.size();
    file += coding.bytes(section.keyword, 4) + coding.bytes(next, coding.link()) + section.payload;
  }
  return file + coding.bytes(54, 4) + coding.bytes(0, coding.link());
}

/// A section with a number that no keyword has, one that is not used, or one of ParMmg's, whose
/// sections differ from other programs' sections of these numbers.
BinarySection random_binary_section(Random& random) {
  const std::array<std::uint64_t, 6> unused = {60, 20, 76, 70, 71, 73};
  BinarySection section{random() % 2 ? any_of(random, unused) : 500 + below(random, 500), ""};
  for (std::size_t n = below(random, 60); n > 0; --n)
    section.payload += static_cast<char>(random());
  return section;
}

TEST(ForeignGmf, LeavesOutWhateverIsBetweenSectionsOfABinaryFile) {
  const test::TemporaryFolder folder;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Coding coding{1 + static_cast<int>(seed % 4),
                        seed % 8 < 4 ? std::endian::little : std::endian::big};
    AnyMesh mesh = test::random_mesh(2 + static_cast<int>(random() % 2), 8, seed, true);
    write_mesh(folder / "a.meshb", mesh, {.version = coding.version, .byte_order = coding.order});
    const std::string file = test::get_bytes(folder / "a.meshb");
    std::vector<BinarySection> all;
    std::size_t added = 0;
    for (const BinarySection& section : sections_of(file, coding)) {
      for (std::size_t n = below(random, 3); n > 0; --n, ++added)
        all.push_back(random_binary_section(random));
      all.push_back(section);
    }
    test::put_bytes(folder / "b.meshb", file_of(file.substr(0, 8), all, coding));
    write_mesh(folder / "c.meshb", mesh, {.version = coding.version, .byte_order = coding.order});
    const AnyMesh expected = read_mesh(folder / "c.meshb");
    Warnings warnings;
    AnyMesh back = read_mesh(folder / "b.meshb", &warnings);
    EXPECT_EQ(warnings.size(), added == 0 ? 0U : 1U);
    back.name = expected.name;
    EXPECT_EQ(back, expected);
  }
}

TEST(ForeignGmf, LeavesOutMeshSectionsAndOthersBesideAField) {
  const test::TemporaryFolder folder;
  test::put_bytes(folder / "a.sol",
                  "MeshVersionFormatted 0\n\nDimension\n2\n\nIdentifier\n\"x\"\n\n"
                  "Origin 0.5 0.5\nSolAtVertices\n2\n1 1\n0.5\n0.25\n\nIterations 7\nEnd\n");
  Warnings warnings;
  EXPECT_EQ(read_field(folder / "a.sol", &warnings).values, (std::vector<double>{0.5, 0.25}));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].ends_with("left out: Identifier, Origin, Iterations")) << warnings[0];
}

// ---- Files of particular programs ----

/// If the geometry has no file of its own, bamg writes it into the mesh file, up to its own End.
TEST(ForeignGmf, GoesPastAGeometryInTheFileOfAMesh) {
  const test::TemporaryFolder folder;
  const std::string triangle =
      "\nVertices\n3\n0 0 1\n1 0 1\n0 1 1\n\nEdges\n3\n1 2 1\n2 3 1\n3 1 1\n";
  const std::string geometry =
      "\nDimension\n2\n\nVertices\n2\n0 0 1\n5 5 1\n\nEdges\n1\n1 2 1\n"
      "\nAngleOfCornerBound\n46\n\nCorners\n2\n1 2\nSubDomainFromGeom\n1\n"
      "2 1 1 0\n";
  test::put_bytes(folder / "a.mesh",
                  "MeshVersionFormatted 0\n\nDimension\n2\n\nIdentifier\n\"G=;1\"\n\nGeometry\n"
                  "\"\"\n\n# BEGIN of the include geometry fileMeshVersionFormatted 0\n" +
                      geometry + "End\n# END of the include geometrie file\n" + triangle +
                      "\nTriangles\n1\n1 2 3 1\n\nSubDomainFromMesh\n1\n3 1 1 0\n\nEnd\n");
  Warnings warnings;
  const AnyMesh mesh = read_mesh(folder / "a.mesh", &warnings);
  EXPECT_EQ(mesh.vertex_count(), 3U);
  EXPECT_EQ(mesh.edges.size(), 3U);
  EXPECT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.corners.size(), 0U);
  EXPECT_EQ(warnings.size(), 1U);
}

TEST(ForeignGmf, TakesTheNameOfAGeometryForWhatItIs) {
  const test::TemporaryFolder folder;
  for (const std::string name : {"\"g.mesh\"", "g.mesh", "\"\"", ""}) {
    test::put_bytes(folder / "a.mesh",
                    "MeshVersionFormatted 1\nDimension 2\nGeometry\n" + name +
                        "\nVertices 3\n0 0 1\n1 0 1\n0 1 1\nTriangles 1\n1 2 3 1\nEnd\n");
    EXPECT_EQ(read_mesh(folder / "a.mesh").triangles.size(), 1U) << name;
  }
}

TEST(ForeignGmf, SaysOfManySectionsHowManyThereAre) {
  const test::TemporaryFolder folder;
  std::string text = "MeshVersionFormatted 1\nDimension 2\n";
  for (int i = 0; i < 30; ++i) text += "Section-" + std::to_string(i) + " 1 2 3\n";
  text += std::string(200, 'X') + "\nVertices 1\n0 0 0\nEnd\n";
  test::put_bytes(folder / "a.mesh", text);
  Warnings warnings;
  read_mesh(folder / "a.mesh", &warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].ends_with("Section-11 and 19 more")) << warnings[0];
}

}  // namespace
}  // namespace ductile::meshadapt::foreign_gmf_test
