// Invalid files: each kind of fault gives an InputError that names file, place and fault, and no
// sequence of bytes does anything worse.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::gmf_errors_test {
namespace {

using Form = WriteOptions::Form;

const std::string good_text =
    "MeshVersionFormatted 2\n"  // 1
    "Dimension 3\n"             // 2
    "Vertices\n"                // 3
    "4\n"                       // 4
    "0 0 0 1\n"                 // 5
    "1 0 0 1\n"                 // 6
    "0 1 0 1\n"                 // 7
    "0 0 1 1\n"                 // 8
    "Tetrahedra\n"              // 9
    "1\n"                       // 10
    "1 2 3 4 5\n"               // 11
    "RequiredVertices 1 4\n"    // 12
    "End\n";                    // 13

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) ADD_FAILURE() << "no '" << part << "'";
  return text.replace(at, part.size(), by);
}

class GmfErrors : public testing::Test {
 protected:
  /// The error of read_mesh for this content, without the folder's name.
  std::string mesh_complaint(const std::string& bytes) {
    test::put_bytes(folder_ / "bad.mesh", bytes);
    return base_name(test::complaint([&] { read_mesh(folder_ / "bad.mesh"); }));
  }
  std::string field_complaint(const std::string& bytes) {
    test::put_bytes(folder_ / "bad.sol", bytes);
    return base_name(test::complaint([&] { read_field(folder_ / "bad.sol"); }));
  }
  std::string base_name(const std::string& text) const {
    const std::string folder = (folder_ / "").string();
    return text.starts_with(folder) ? text.substr(folder.size()) : text;
  }
  Warnings mesh_warnings(const std::string& text) {
    test::put_bytes(folder_ / "odd.mesh", text);
    Warnings warnings;
    read_mesh(folder_ / "odd.mesh", &warnings);
    for (std::string& warning : warnings) warning = base_name(warning);
    return warnings;
  }

  test::TemporaryFolder folder_;
};

/// Expects that the complaint begins with the place and contains the fault.
void expect_says(const std::string& complaint, const std::string& place, const std::string& fault) {
  EXPECT_TRUE(complaint.starts_with(place)) << complaint;
  EXPECT_NE(complaint.find(fault), std::string::npos) << complaint;
  EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
}

// ---- Missing, empty and special files ----

TEST_F(GmfErrors, NameWhatCannotBeRead) {
  const auto complaint = [&](const std::string& name) {
    return base_name(test::complaint([&] { read_mesh(folder_ / name); }));
  };
  expect_says(complaint("none.mesh"), "none.mesh: ", "No such file");
  EXPECT_NE(test::complaint([&] { read_mesh(folder_ / ""); }).find("found a folder"),
            std::string::npos);
  expect_says(test::complaint([] { read_mesh(""); }), "expected the name", "empty");
  expect_says(test::complaint([] { read_mesh("/dev/zero"); }), "/dev/zero: ", "found a device");
  expect_says(mesh_complaint(""), "bad.mesh: ", "found an empty file");
  expect_says(mesh_complaint("$Mesh\n4.1 0 8\n"), "bad.mesh:1: ", "MeshVersionFormatted");
  expect_says(mesh_complaint(" \n\n# nothing\n"), "bad.mesh:4: ", "MeshVersionFormatted");
}

// ---- Text ----

struct Fault {
  std::string part, by, place, says;
};

TEST_F(GmfErrors, NameTheLineAndFaultOfAText) {
  const std::vector<Fault> faults = {
      // Heads
      {"Formatted 2", "Formatted 5", "bad.mesh:1: ", "version 1 to 4, found 5"},
      {"Formatted 2", "Formatted two", "bad.mesh:1: ", "found 'two'"},
      {"Dimension 3", "Dimension 4", "bad.mesh:2: ", "Dimension 2 or 3, found 4"},
      {"Dimension 3", "Dimension 3 Dimension 3", "bad.mesh:2: ", "found a second"},
      {"Dimension 3\n", "\n", "bad.mesh:3: ", "expected Dimension before Vertices"},
      {"Dimension 3\n", "MeshVersionFormatted 2\n", "bad.mesh:2: ", "found a second"},
      {"Dimension 3", "Dimension 2", "bad.mesh:8: ", "correct that or the Dimension"},
      {"Tetrahedra", "Tetraedra", "bad.mesh:9: ", "did you mean Tetrahedra?"},
      {"Tetrahedra", "tetrahedra", "bad.mesh:9: ", "did you mean Tetrahedra?"},
      {"Tetrahedra", "Gr?ff", "bad.mesh:9: ", "expected a keyword after Vertices, found 'Gr?ff'"},
      {"Vertices 1 4", "Vertices 1 4\nCorners 1 1\nCorners 1 1",
       "bad.mesh:14: ", "expected one section Corners, found a second"},
      // Counts
      {"Vertices\n4", "Vertices\n-4", "bad.mesh:4: ", "found -4"},
      {"Vertices\n4", "Vertices\n1000000000", "bad.mesh:4: ", "found a count of 1000000000"},
      {"Vertices\n4", "Vertices\n9999999999", "bad.mesh:4: ", "found 9999999999"},
      {"Vertices\n4", "Vertices\n99999999999999999999", "bad.mesh:4: ", "found '99999999999999999"},
      {"Vertices\n4", "Vertices\n4.5", "bad.mesh:4: ", "an integer after Vertices, found '4.5'"},
      {"Vertices\n4", "Vertices\n3", "bad.mesh:8: ", "more lines than its count"},
      {"Vertices\n4", "Vertices\n5", "bad.mesh:9: ", "Vertices 5 of 5, found the keyword Tetra"},
      {"Vertices\n4", "Vertices\n", "bad.mesh:5: ", "more lines than its count"},
      {"Tetrahedra\n1", "Tetrahedra\n2", "bad.mesh:12: ", "found the keyword RequiredVertices"},
      // Numbers
      {"0 1 0 1", "0 nan 0 1", "bad.mesh:7: ", "finite number in Vertices 3 of 4, found 'nan'"},
      {"0 1 0 1", "0 -inf 0 1", "bad.mesh:7: ", "found '-inf'"},
      {"0 1 0 1", "0 1e309 0 1", "bad.mesh:7: ", "finite number in Vertices 3 of 4, found '1e309'"},
      {"0 1 0 1", "0 1,5 0 1", "bad.mesh:7: ", "found '1,5'"},
      {"0 1 0 1", "0 0x1 0 1", "bad.mesh:7: ", "found '0x1'"},
      {"0 1 0 1", "0 1 0 1.5", "bad.mesh:7: ", "an integer in Vertices 3 of 4, found '1.5'"},
      {"0 1 0 1", "0 1 0 3000000000", "bad.mesh:7: ", "reference of 32 bits in Vertices 3 of 4"},
      {"0 1 0 1", "0 1 \x01 1", "bad.mesh:7: ", "found '?'"},
      // Indices
      {"1 2 3 4 5", "1 2 7 4 5", "bad.mesh:11: ", "in Tetrahedra 1 of 1, found 7"},
      {"1 2 3 4 5", "1 0 3 4 5", "bad.mesh:11: ", "at least 1 in Tetrahedra 1 of 1, found 0"},
      {"1 2 3 4 5", "1 -2 3 4 5", "bad.mesh:11: ", "found -2"},
      {"Vertices 1 4", "Vertices 1 5", "bad.mesh:12: ", "in RequiredVertices 1 of 1, found 5"},
      {"Vertices 1 4", "Vertices 1 4 Ridges 1 1", "bad.mesh:12: ", "up to 0, the count of Edges"},
      // Cells of other kinds
      {"End", "Hexahedra 1 1 2 3 4 1 2 3 4 0 End", "bad.mesh:13: ", "1 Hexahedra (mixed"},
      {"End", "Quadrilaterals 1 1 2 3 4 0 End", "bad.mesh:13: ", "1 Quadrilaterals (mixed"},
      {"End", "Prisms 1 1 2 3 4 1 2 0 End", "bad.mesh:13: ", "1 Prisms (mixed"},
      {"End", "Pyramids 1 1 2 3 4 1 0 End", "bad.mesh:13: ", "1 Pyramids (mixed"},
      {"End", "TetrahedraP2 1 1 2 3 4 1 2 3 4 1 2 0 End", "bad.mesh:13: ", "1 TetrahedraP2 (mixed"},
      // The end
      {"End\n", "End\n1 2 3\n", "bad.mesh:14: ", "nothing after the keyword End"},
      {"End\n", "End End\n", "bad.mesh:13: ", "nothing after the keyword End"},
      {"Vertices 1 4\nEnd\n", "Vertices 1 4", "bad.mesh:12: ", "the file is cut short"},
      {"Vertices 1 4\nEnd\n", "Vertices 2 4\n", "bad.mesh:13: ", "found the end of the file"},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.part + " -> " + fault.by);
    expect_says(mesh_complaint(replaced(good_text, fault.part, fault.by)), fault.place, fault.says);
  }
  expect_says(mesh_complaint("MeshVersionFormatted 2\nDimension 2\nTetrahedra 1\n1 1 1 1 0\nEnd\n"),
              "bad.mesh:3: ", "no Tetrahedra in Dimension 2");
  expect_says(mesh_complaint("MeshVersionFormatted 2\nDimension 2\nEnd\n"),
              "bad.mesh:4: ", "expected the section Vertices, found none");
}

TEST_F(GmfErrors, NameTheLineAndFaultOfAField) {
  const std::string good =
      "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n2\n1 3\n1 0 1\n2 0 2\nEnd\n";
  test::put_bytes(folder_ / "good.sol", good);
  EXPECT_EQ(read_field(folder_ / "good.sol").vertex_count, 2U);
  const std::vector<Fault> faults = {
      {"1 3\n", "0\n", "bad.sol:5: ", "fields from 1 to 1000, found 0"},
      {"1 3\n", "1 7\n", "bad.sol:5: ", "found 7"},
      {"1 3\n", "-1 3\n", "bad.sol:5: ", "found -1"},
      {"1 3\n", "999 3\n", "bad.sol:6: ", "a field's type"},
      {"\n2\n1", "\n200000\n1", "bad.sol:5: ", "a count of 200000"},
      {"2 0 2", "2 0", "bad.sol:8: ", "SolAtVertices 2 of 2, found the keyword End"},
      {"2 0 2", "2 0 NaN", "bad.sol:7: ", "finite number"},
      {"SolAtVertices", "SolAtTetrahedra", "bad.sol:9: ", "section SolAtVertices, found none"},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.part + " -> " + fault.by);
    expect_says(field_complaint(replaced(good, fault.part, fault.by)), fault.place, fault.says);
  }
  expect_says(field_complaint(good_text), "bad.sol:14: ", "found none; give a file with a field");
}

TEST_F(GmfErrors, NeverMissACutText) {
  // The last cut leaves out only a newline.
  for (std::size_t length = 0; length + 5 < good_text.size(); ++length) {
    const std::string cut = good_text.substr(0, length);
    test::put_bytes(folder_ / "cut.mesh", cut);
    Warnings warnings;
    try {
      read_mesh(folder_ / "cut.mesh", &warnings);
      EXPECT_FALSE(warnings.empty()) << cut;
      EXPECT_TRUE(cut.ends_with('\n')) << cut;
    } catch (const InputError&) {
    }
  }
}

TEST_F(GmfErrors, NeverMissACutField) {
  std::string text = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n8\n2 1 2\n";
  for (int v = 0; v < 8; ++v)
    text += "0.12345678901234567 1.1234567890123457 -2.1234567890123457\n";
  const std::string whole = text + "End\n";
  test::put_bytes(folder_ / "whole.sol", whole);
  ASSERT_EQ(read_field(folder_ / "whole.sol").values.size(), 24U);
  for (std::size_t length = 0; length < text.size(); ++length)
    EXPECT_NE(field_complaint(whole.substr(0, length)), "") << length;
  EXPECT_NE(field_complaint(whole.substr(0, text.size() / 2)).find("the file is cut short"),
            std::string::npos);
}

TEST_F(GmfErrors, TakeNoSignForANumber) {
  for (const char* wrong : {"+-1", "-+1", "++1", "+ 1", "+", "-", "+\n#x\n1"}) {
    EXPECT_TRUE(mesh_complaint(replaced(good_text, "1 0 0 1", std::string(wrong) + " 0 0 1"))
                    .starts_with("bad.mesh:6: expected a finite number"))
        << wrong;
    EXPECT_TRUE(mesh_complaint(replaced(good_text, "1 0 0 1", std::string("1 0 0 ") + wrong))
                    .starts_with("bad.mesh:6: expected an integer"))
        << wrong;
  }
}

// ---- Unusual but valid ----

TEST_F(GmfErrors, AcceptFreeFormText) {
  const std::string text =
      "\xEF\xBB\xBF# a comment\r\n MeshVersionFormatted\r\n1\r\nDimension\t2#two\r\n Vertices 3 # "
      "three\n"
      "+1 .5 -7 1.D+00 2d-3 0 1e-400 -0.0000 +8\nTriangles\n1\n1 2\n3\n-4 Corners 0\nEnd";
  EXPECT_TRUE(mesh_warnings(text).empty());
  const AnyMesh mesh = read_mesh(folder_ / "odd.mesh");
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{1, .5, 1, 2e-3, 0, 0}));
  EXPECT_EQ(mesh.vertex_reference, (std::vector<std::int32_t>{-7, 0, 8}));
  EXPECT_EQ(mesh.triangles.reference, (std::vector<std::int32_t>{-4}));
}

TEST_F(GmfErrors, ReportWhatIsLeftOut) {
  const std::string more =
      "Normals\n2\n0 0 1\n0 1 0\nNormalAtVertices 2 1 1 2 2\nBoundingBox 0 1 0 1 0 1\n"
      "Quadrilaterals 0\nComments 1 \"made by 4 hands\"\nEnd\n";
  const Warnings warnings = mesh_warnings(replaced(good_text, "End\n", more));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "odd.mesh:13: sections that Ductile does not use are left out: Normals (2), "
            "NormalAtVertices (2), BoundingBox, Quadrilaterals (0), Comments (1)");
}

TEST_F(GmfErrors, TakeAnyWordsInSectionsOfText) {
  for (const std::string more :
       {"Comments 2\nmade of Triangles by hand\nThe End of it\nEnd\n",
        "Comments 1\r\nThe End of it\r\nEnd\r\n", "Comments 1 \"Vertices and all\"\rEnd\r",
        "ReferenceStrings\n1\n6 1 Vertices wall\nEnd\n", "Comments 2\none, not two\nEnd\n"}) {
    const Warnings warnings = mesh_warnings(replaced(good_text, "End\n", more));
    EXPECT_EQ(warnings.size(), 1U) << more;
  }
}

TEST_F(GmfErrors, TakeLinesThatEndAsOnOldMachines) {
  std::string text = replaced(good_text, "Tetrahedra", "# four vertices\nTetrahedra");
  std::replace(text.begin(), text.end(), '\n', '\r');
  EXPECT_TRUE(mesh_warnings(text).empty());
  EXPECT_EQ(read_mesh(folder_ / "odd.mesh").tetrahedra.size(), 1U);
  EXPECT_TRUE(
      mesh_complaint(replaced(text, "1 2 3 4 5", "1 2 3 9 5")).starts_with("bad.mesh:12: "));
}

TEST_F(GmfErrors, ReportAMissingEnd) {
  const Warnings warnings = mesh_warnings(replaced(good_text, "End\n", ""));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with("odd.mesh:13: expected the keyword End")) << warnings[0];
}

TEST_F(GmfErrors, TakeAFlatMeshInSpaceForOneOfThePlane) {
  const std::string text =
      "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 1\n1 0 0 2\n0 1 0 3\n"
      "Triangles 1\n1 2 3 0\nEnd\n";
  const Warnings warnings = mesh_warnings(text);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("dimension 2"), std::string::npos);
  const AnyMesh mesh = read_mesh(folder_ / "odd.mesh");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_TRUE(mesh_warnings(replaced(text, "0 1 0 3", "0 1 0.5 3")).empty());
  EXPECT_EQ(read_mesh(folder_ / "odd.mesh").dimension, 3);
}

// ---- Binary ----

class GmfBinaryErrors : public GmfErrors {
 protected:
  GmfBinaryErrors() {
    test::put_bytes(folder_ / "good.mesh", good_text);
    write_mesh(folder_ / "good.meshb", read_mesh(folder_ / "good.mesh"));
    good_ = test::get_bytes(folder_ / "good.meshb");
  }
  /// The good file with the 32-bit number at one byte replaced.
  std::string with(std::size_t at, std::int32_t value) const {
    std::string bytes = good_;
    std::memcpy(bytes.data() + at, &value, 4);
    return bytes;
  }

  // Version 2: Dimension at 8, Vertices at 20 (records of 28 bytes from 32), Tetrahedra at 144 (one
  // record from 156), RequiredVertices at 176 (from 188), End at 192.
  std::string good_;
};

TEST_F(GmfBinaryErrors, NameTheByteAndSection) {
  ASSERT_EQ(good_.size(), 200U);
  struct {
    std::size_t at;
    std::int32_t value;
    std::string place, says;
  } const faults[] = {
      {4, 5, "bad.mesh: byte 4, ", "version 1 to 4, found 5"},
      {8, 0, "bad.mesh: byte 8: ", "number of a keyword, found 0"},
      {8, 77777, "bad.mesh: byte 8: ", "number of a keyword, found 77777"},
      {12, 21, "bad.mesh: byte 20, Dimension: ", "found its end at byte 21"},
      {12, 8, "bad.mesh: byte 12, Dimension: ", "position of the next section"},
      {12, -1, "bad.mesh: byte 12, Dimension: ", "found -1"},
      {12, 1 << 30, "bad.mesh: byte 12, Dimension: ", "from byte 16 to 199, found 1073741824"},
      {16, 7, "bad.mesh: byte 16, Dimension: ", "found 7"},
      {20, 3, "bad.mesh: byte 28, Dimension: ", "found a second"},
      {24, 20, "bad.mesh: byte 24, Vertices: ", "position of the next section"},
      {24, 200, "bad.mesh: byte 24, Vertices: ", "position of the next section"},
      {28, 5,
       "bad.mesh: byte 28: ", "at most 4 Vertices in the rest of the section, found a count of 5"},
      {28, 3, "bad.mesh: byte 116, Vertices: ", "found its end at byte 144"},
      {28, -4, "bad.mesh: byte 28, Vertices: ", "found -4"},
      {28, 1 << 30, "bad.mesh: byte 28: ", "at most 4 Vertices"},
      {60 + 4, 0x7ff80000, "bad.mesh: byte 60, Vertices: ", "finite number in Vertices 2 of 4"},
      {60 + 4, 0x7ff00000, "bad.mesh: byte 60, Vertices: ", "found inf"},
      {144, 10, "bad.mesh: byte 152, Hexahedra: ", "1 Hexahedra (mixed"},
      {160, 7, "bad.mesh: byte 160, Tetrahedra: ", "in Tetrahedra 1 of 1, found 7"},
      {160, 0, "bad.mesh: byte 160, Tetrahedra: ", "at least 1 in Tetrahedra 1 of 1, found 0"},
      {188, 5, "bad.mesh: byte 188, RequiredVertices: ", "found 5"},
      {192, 55, "bad.mesh: byte 200, TrianglesOnGeometricTriangles: ", ""},
  };
  for (const auto& [at, value, place, says] : faults) {
    SCOPED_TRACE(std::to_string(at) + " = " + std::to_string(value));
    expect_says(mesh_complaint(with(at, value)), place, says);
  }
}

TEST_F(GmfBinaryErrors, NeverMissACutFile) {
  for (std::size_t length = 0; length < good_.size(); ++length) {
    if (length == good_.size() - 4) continue;  // End without a position, as Mmg writes it
    SCOPED_TRACE(length);
    EXPECT_TRUE(mesh_complaint(good_.substr(0, length)).starts_with("bad.mesh"));
  }
  expect_says(mesh_complaint(good_ + "x"), "bad.mesh: byte 196, End: ", "found 5 bytes");
}

TEST_F(GmfBinaryErrors, LeaveOutUnknownSectionsByTheirLink) {
  for (const auto& [code, text] : {std::pair{900, "left out: keyword 900 (24 bytes)"},
                                   std::pair{60, "left out: Normals (24 bytes)"}}) {
    test::put_bytes(folder_ / "odd.meshb", with(144, code));
    Warnings warnings;
    const AnyMesh mesh = read_mesh(folder_ / "odd.meshb", &warnings);
    EXPECT_EQ(mesh.tetrahedra.size(), 0U);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find(text), std::string::npos) << warnings[0];
  }
}

TEST_F(GmfBinaryErrors, AcceptALastLinkOfZero) {
  std::string bytes = with(180, 0).substr(0, 192);
  test::put_bytes(folder_ / "odd.meshb", bytes);
  Warnings warnings;
  EXPECT_EQ(read_mesh(folder_ / "odd.meshb", &warnings).required_vertices.size(), 1U);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("without the keyword End"), std::string::npos);
}

// ---- Writing ----

TEST_F(GmfErrors, WritersRefuseWhatDoesNotFit) {
  const AnyMesh mesh = test::random_mesh(2, 5, 1, true);
  expect_says(base_name(test::complaint([&] { write_mesh(folder_ / "a.xyz", mesh); })),
              "a.xyz: ", "ends in .mesh, .meshb");
  expect_says(base_name(test::complaint([&] { write_mesh(folder_ / "no/a.mesh", mesh); })),
              "no/a.mesh: ", "there is no folder");
  EXPECT_THROW(write_mesh(folder_ / "a.mesh", mesh, {.version = 5}), InputError);
  AnyMesh wrong = mesh;
  wrong.triangles.vertices[0][0] = 5;
  EXPECT_THROW(write_mesh(folder_ / "a.mesh", wrong), Error);
  wrong = mesh;
  wrong.coordinates[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_mesh(folder_ / "a.meshb", wrong), Error);
  wrong.coordinates[3] = 1e300;
  write_mesh(folder_ / "a.meshb", wrong);
  EXPECT_THROW(write_mesh(folder_ / "b.meshb", wrong, {.version = 1}), Error);
  EXPECT_EQ(folder_.file_count(), 1U);
}

}  // namespace
}  // namespace ductile::meshadapt::gmf_errors_test
