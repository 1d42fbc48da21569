#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::vtu_test {
namespace {

using Type = AnyField::Type;

/// Callers often have their fields in a vector.
void write_vtu(const std::filesystem::path& path, const AnyMesh& mesh,
               const std::vector<NamedField>& fields = {}) {
  write_mesh(path, mesh, {.fields = fields});
}

// ---- A reader of its own, from the description of the format ----

int value_of(char letter) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return static_cast<int>(letters.find(letter));
}

std::string decode(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i + 4 <= text.size(); i += 4) {
    int group = 0;
    int padding = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      padding += text[i + k] == '=';
      group = group * 64 + (text[i + k] == '=' ? 0 : value_of(text[i + k]));
    }
    for (int k = 0; k < 3 - padding; ++k)
      bytes.push_back(static_cast<char>(group >> (16 - 8 * k) & 255));
  }
  return bytes;
}

std::uint64_t table_entry(const std::string& table, std::size_t i) {
  std::uint64_t value = 0;
  std::memcpy(&value, table.data() + 8 * i, 8);
  return value;
}

template <class Number>
std::vector<Number> array_of(pugi::xml_node parent, const char* name) {
  const pugi::xml_node node = parent.find_child_by_attribute("DataArray", "Name", name);
  const std::string_view text = node.text().get();
  EXPECT_STREQ(node.attribute("format").value(), "binary");
  const auto blocks = static_cast<std::size_t>(table_entry(decode(text.substr(0, 12)), 0));
  const std::size_t table_length = (8 * (3 + blocks) + 2) / 3 * 4;
  const std::string table = decode(text.substr(0, table_length));
  const std::string data = decode(text.substr(table_length));
  std::string bytes;
  std::size_t at = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    const bool is_partial = block + 1 == blocks && table_entry(table, 2) != 0;
    uLongf size = table_entry(table, is_partial ? 2 : 1);
    const std::size_t expected = size;
    std::string part(size, '\0');
    EXPECT_EQ(Z_OK, uncompress(reinterpret_cast<Bytef*>(part.data()), &size,
                               reinterpret_cast<const Bytef*>(data.data() + at),
                               table_entry(table, 3 + block)));
    EXPECT_EQ(size, expected);
    at += table_entry(table, 3 + block);
    bytes += part;
  }
  EXPECT_EQ(at, data.size());
  std::vector<Number> values(bytes.size() / sizeof(Number));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

struct Vtu {
  explicit Vtu(const std::filesystem::path& path) {
    EXPECT_TRUE(document.load_file(path.c_str()));
    const pugi::xml_node file = document.child("VTKFile");
    EXPECT_STREQ(file.attribute("type").value(), "UnstructuredGrid");
    EXPECT_STREQ(file.attribute("compressor").value(), "vtkZLibDataCompressor");
    EXPECT_STREQ(file.attribute("header_type").value(), "UInt64");
    piece = file.child("UnstructuredGrid").child("Piece");
  }
  pugi::xml_document document;
  pugi::xml_node piece;
};

template <int Corners>
void append(std::vector<std::int64_t>& list, const Cells<Corners>& cells) {
  for (const auto& vertices : cells.vertices)
    list.insert(list.end(), vertices.begin(), vertices.end());
}

class VtuFile : public testing::TestWithParam<int> {
 protected:
  test::TemporaryFolder folder_;
};

TEST_P(VtuFile, HoldsTheMesh) {
  // Enough vertices for several blocks.
  const AnyMesh mesh = test::random_mesh(GetParam(), 100000, 1);
  write_vtu(folder_ / "a.vtu", mesh);
  const Vtu vtu(folder_ / "a.vtu");
  EXPECT_EQ(vtu.piece.attribute("NumberOfPoints").as_ullong(), mesh.vertex_count());
  const auto points = array_of<double>(vtu.piece.child("Points"), "Points");
  ASSERT_EQ(points.size(), 3 * mesh.vertex_count());
  const auto dimension = static_cast<std::size_t>(GetParam());
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_EQ(points[i], i % 3 < dimension ? mesh.coordinates[i / 3 * dimension + i % 3] : 0.0);
  const pugi::xml_node cells = vtu.piece.child("Cells");
  std::vector<std::int64_t> connectivity;
  append(connectivity, mesh.tetrahedra);
  append(connectivity, mesh.triangles);
  append(connectivity, mesh.edges);
  EXPECT_EQ(array_of<std::int64_t>(cells, "connectivity"), connectivity);
  const auto offsets = array_of<std::int64_t>(cells, "offsets");
  const auto types = array_of<std::uint8_t>(cells, "types");
  ASSERT_EQ(offsets.size(), vtu.piece.attribute("NumberOfCells").as_ullong());
  ASSERT_EQ(types.size(), offsets.size());
  for (std::size_t i = 0; i < types.size(); ++i)
    ASSERT_EQ(offsets[i] - (i ? offsets[i - 1] : 0), types[i] == 10 ? 4 : types[i] == 5 ? 3 : 2);
  std::vector<std::int32_t> region, boundary;
  for (const auto* references :
       {&mesh.tetrahedra.reference, &mesh.triangles.reference, &mesh.edges.reference}) {
    const bool elements =
        references == (dimension == 2 ? &mesh.triangles.reference : &mesh.tetrahedra.reference);
    for (const std::int32_t reference : *references) {
      region.push_back(elements ? reference : 0);
      boundary.push_back(elements ? 0 : reference);
    }
  }
  EXPECT_EQ(array_of<std::int32_t>(vtu.piece.child("CellData"), "region"), region);
  EXPECT_EQ(array_of<std::int32_t>(vtu.piece.child("CellData"), "boundary"), boundary);
  EXPECT_EQ(array_of<std::int32_t>(vtu.piece.child("PointData"), "reference"),
            mesh.vertex_reference);
}

INSTANTIATE_TEST_SUITE_P(Dimension, VtuFile, testing::Values(2, 3));

TEST(Vtu, WidensTensorsAndVectors) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = test::random_mesh(3, 1, 1);
  const std::vector<NamedField> in_space = {{"size <&>", Type::scalar, {7}},
                                            {"metric", Type::symmetric, {11, 12, 22, 13, 23, 33}},
                                            {"matrix", Type::matrix, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
  write_vtu(folder / "a.vtu", mesh, in_space);
  const Vtu space(folder / "a.vtu");
  using Values = std::vector<double>;
  const pugi::xml_node data = space.piece.child("PointData");
  EXPECT_EQ(array_of<double>(data, "size <&>"), (Values{7}));
  EXPECT_EQ(array_of<double>(data, "metric"), (Values{11, 12, 13, 12, 22, 23, 13, 23, 33}));
  EXPECT_EQ(array_of<double>(data, "matrix"), (Values{1, 2, 3, 4, 5, 6, 7, 8, 9}));

  mesh = test::random_mesh(2, 1, 1);
  write_vtu(folder / "b.vtu", mesh,
            {{"metric", Type::symmetric, {11, 12, 22}}, {"wind", Type::vector, {1, 2}}});
  const Vtu plane(folder / "b.vtu");
  EXPECT_EQ(array_of<double>(plane.piece.child("PointData"), "metric"),
            (Values{11, 12, 0, 12, 22, 0, 0, 0, 0}));
  EXPECT_EQ(array_of<double>(plane.piece.child("PointData"), "wind"), (Values{1, 2, 0}));
}

TEST(Vtu, TakesFieldsApart) {
  const AnyField field = test::random_field(2, 3, {Type::scalar, Type::symmetric, Type::vector}, 1);
  const auto parts = named_fields(field, "u");
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_EQ(parts[1].name, "u_2");
  EXPECT_EQ(parts[1].type, Type::symmetric);
  for (std::size_t vertex = 0; vertex < 3; ++vertex)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(parts[1].values[3 * vertex + i], field.values[6 * vertex + 1 + i]);
}

TEST(Vtu, TakesNoFieldApartThatLacksValues) {
  AnyField field = test::random_field(2, 3, {Type::scalar, Type::vector}, 1);
  field.name = "u.sol";
  field.values.pop_back();
  EXPECT_EQ(
      test::complaint([&] { named_fields(field, "u"); }),
      "u.sol: expected numbers for all components at all vertices, 9 of them, found 8 in values");
}

TEST(Vtu, GivesEachFieldANameOfItsOwn) {
  const test::TemporaryFolder folder;
  const AnyMesh mesh = test::random_mesh(2, 1, 1);
  write_vtu(folder / "a.vtu", mesh,
            {{"reference", Type::scalar, {1}}, {"h", Type::scalar, {2}}, {"h", Type::scalar, {3}}});
  const Vtu file(folder / "a.vtu");
  const auto value = [&](const char* name) {
    return array_of<double>(file.piece.child("PointData"), name);
  };
  EXPECT_EQ(value("reference_2"), (std::vector<double>{1}));
  EXPECT_EQ(value("h"), (std::vector<double>{2}));
  EXPECT_EQ(value("h_2"), (std::vector<double>{3}));
}

TEST(Vtu, RefusesAFieldOfAnotherMesh) {
  const test::TemporaryFolder folder;
  const AnyMesh mesh = test::random_mesh(2, 4, 1);
  EXPECT_THROW(write_vtu(folder / "a.vtu", mesh, {{"h", Type::scalar, {1, 2, 3}}}), Error);
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Vtu, RefusesAMeshThatLacksReferences) {
  const test::TemporaryFolder folder;
  AnyMesh mesh = box_mesh<2>({1, 1}, {2, 2});
  mesh.triangles.reference.pop_back();
  EXPECT_NE(test::complaint([&] { write_vtu(folder / "a.vtu", mesh, {}); }), "");
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace ductile::meshadapt::vtu_test
