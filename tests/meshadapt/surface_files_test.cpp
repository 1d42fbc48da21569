/// @file
/// Files of surfaces: STL, PLY and OBJ, text and binary.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/files.hpp"
#include "io_support.hpp"

namespace ductile::meshadapt::surface_files_test {
namespace {

using Form = WriteOptions::Form;

/// A tetrahedron's surface, with coordinates that single precision holds, or not.
AnyMesh pyramid(bool single) {
  AnyMesh mesh;
  mesh.dimension = 3;
  const double x = single ? 0.5 : 0.1;
  mesh.coordinates = {0, 0, 0, 1, 0, x, 0, 1, 0, 0, 0, 1};
  mesh.vertex_reference.assign(4, 0);
  mesh.triangles.add({0, 2, 1}, 5);
  mesh.triangles.add({0, 1, 3}, 5);
  mesh.triangles.add({1, 2, 3}, 7);
  mesh.triangles.add({2, 0, 3}, -2);
  return mesh;
}

std::array<std::array<double, 3>, 3> corners_at(const AnyMesh& mesh, std::size_t t) {
  std::array<std::array<double, 3>, 3> points;
  for (std::size_t i = 0; i < 3; ++i)
    std::copy_n(&mesh.coordinates[3 * std::size_t{mesh.triangles.vertices[t][i]}], 3,
                points[i].begin());
  return points;
}

class SurfaceFiles : public testing::TestWithParam<std::pair<const char*, Form>> {
 protected:
  std::filesystem::path path() const { return folder_ / (std::string("part") + GetParam().first); }
  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(
    Formats, SurfaceFiles,
    testing::Values(std::pair{".stl", Form::by_name}, std::pair{".stl", Form::ascii},
                    std::pair{".ply", Form::by_name}, std::pair{".ply", Form::ascii},
                    std::pair{".obj", Form::by_name}),
    [](const auto& at) {
      return std::string(at.param.first).substr(1) + (at.param.second == Form::ascii ? "Text" : "");
    });

TEST_P(SurfaceFiles, AreReadAsTheyWereWritten) {
  const auto [ending, form] = GetParam();
  const bool is_stl = std::string(ending) == ".stl", single = is_stl && form != Form::ascii;
  const AnyMesh mesh = pyramid(single);
  write_mesh(path(), mesh, {.form = form});
  const AnyMesh read = read_mesh(path());
  ASSERT_EQ(read.dimension, 3);
  EXPECT_EQ(read.vertex_count(), 4U);
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < 4; ++t) EXPECT_EQ(corners_at(read, t), corners_at(mesh, t));
  if (!is_stl) {
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
}

/// Whatever is cut off or changed, it is read or refused.
TEST_P(SurfaceFiles, AreReadOrRefusedWhateverIsInThem) {
  const auto [ending, form] = GetParam();
  write_mesh(path(), pyramid(true), {.form = form});
  const std::string whole = test::get_bytes(path());
  std::mt19937 random(5);
  std::size_t refused = 0;
  for (int k = 0; k < 2000; ++k) {
    std::string bytes = whole;
    if (k % 2 == 0) bytes.resize(1 + random() % bytes.size());
    for (unsigned changes = random() % 4; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    test::put_bytes(path(), bytes);
    try {
      const AnyMesh read = read_mesh(path());
      for (const auto& corners : read.triangles.vertices)
        for (const std::uint32_t v : corners) ASSERT_LT(v, read.vertex_count());
    } catch (const InputError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("part"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 100U);
}

TEST(SurfaceFile, OfStlHasSolidsAsReferences) {
  const test::TemporaryFolder folder;
  const auto path = folder / "two.stl";
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1e0\nendloop\n"
      "endfacet\n";
  test::put_bytes(path, "solid lid\n" + facet + "endsolid lid\nsolid wall of it\n" + facet + facet +
                            "endsolid\n");
  const AnyMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.vertex_count(), 3U);
  EXPECT_EQ(mesh.triangles.reference, (std::vector<std::int32_t>{1, 2, 2}));
  ASSERT_EQ(mesh.names.size(), 2U);
  EXPECT_EQ(mesh.names[1].name, "wall of it");
}

TEST(SurfaceFile, OfObjMayHavePolygonsGroupsAndNegativeNumbers) {
  const test::TemporaryFolder folder;
  const auto path = folder / "quad.obj";
  test::put_bytes(path,
                  "# a comment\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 0.5\nv 1 1 1\nv 0 1 0\nvn 0 0 1\n"
                  "g wall\nf 1/1/1 2//1 3 4\ng 9\nf -4 -3 -1\n");
  Warnings warnings;
  const AnyMesh mesh = read_mesh(path, &warnings);
  EXPECT_EQ(mesh.triangles.vertices,
            (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}}));
  EXPECT_EQ(mesh.triangles.reference, (std::vector<std::int32_t>{1, 1, 9}));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("cut into triangles"), std::string::npos);
}

TEST(SurfaceFile, OfPlyMayHaveOtherPropertiesAndByteOrder) {
  const test::TemporaryFolder folder;
  const auto path = folder / "big.ply";
  std::string bytes =
      "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty uchar red\r\n"
      "property float x\r\nproperty float y\r\nproperty double z\r\nelement face 1\r\n"
      "property list uchar float weights\r\nproperty list uchar ushort vertex_index\r\n"
      "end_header\r\n";
  bytes = bytes.substr(0, bytes.size() - 2) + "\n";
  const auto put = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
  };
  for (int v = 0; v < 3; ++v) {
    put(static_cast<std::uint8_t>(9));
    put(static_cast<float>(v == 1));
    put(static_cast<float>(v == 2));
    put(v * 0.3);
  }
  put(static_cast<std::uint8_t>(1));
  put(2.5F);
  put(static_cast<std::uint8_t>(3));
  for (std::uint16_t v = 0; v < 3; ++v) put(v);
  test::put_bytes(path, bytes);
  const AnyMesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 0, 1, 0, 0.3, 0, 1, 0.6}));
  EXPECT_EQ(mesh.triangles.vertices[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

}  // namespace
}  // namespace ductile::meshadapt::surface_files_test
