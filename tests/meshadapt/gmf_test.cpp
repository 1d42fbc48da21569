#include "ductile/meshadapt/files.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <string>
#include <tuple>
#include <vector>

#include "io_support.hpp"

namespace ductile::meshadapt::gmf_test {
namespace {

using Form = WriteOptions::Form;
using Type = AnyField::Type;

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

template <int Corners>
void expect_same(const Cells<Corners>& a, const Cells<Corners>& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.reference, b.reference);
}

void expect_same(const AnyMesh& a, const AnyMesh& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  expect_same_bits(a.coordinates, b.coordinates);
  EXPECT_EQ(a.vertex_reference, b.vertex_reference);
  expect_same(a.edges, b.edges);
  expect_same(a.triangles, b.triangles);
  expect_same(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.required_vertices, b.required_vertices);
  EXPECT_EQ(a.ridges, b.ridges);
  EXPECT_EQ(a.required_edges, b.required_edges);
  EXPECT_EQ(a.required_triangles, b.required_triangles);
  EXPECT_EQ(a.required_tetrahedra, b.required_tetrahedra);
}

void expect_same(const AnyField& a, const AnyField& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_EQ(a.vertex_count, b.vertex_count);
  EXPECT_EQ(a.types, b.types);
  expect_same_bits(a.values, b.values);
}

// ---- Round trips, over form, version, byte order and dimension ----

class GmfRoundTrip : public testing::TestWithParam<std::tuple<Form, int, std::endian, int>> {
 protected:
  WriteOptions options() const {
    const auto [form, version, byte_order, dimension] = GetParam();
    return {.version = version, .form = form, .byte_order = byte_order};
  }
  int dimension() const { return std::get<3>(GetParam()); }
  bool has_floats() const { return options().version == 1 && options().form == Form::binary; }

  test::TemporaryFolder folder_;
};

TEST_P(GmfRoundTrip, KeepsAMeshBitForBit) {
  for (const std::size_t size : {1, 2, 30, 1000}) {
    const AnyMesh mesh =
        test::random_mesh(dimension(), size, static_cast<unsigned>(size), has_floats());
    write_mesh(folder_ / "a.mesh", mesh, options());
    Warnings warnings;
    const AnyMesh back = read_mesh(folder_ / "a.mesh", &warnings);
    expect_same(mesh, back);
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_EQ(back.name, (folder_ / "a.mesh").string());
  }
}

TEST_P(GmfRoundTrip, KeepsFieldsBitForBit) {
  const std::vector<std::vector<Type>> kinds = {
      {Type::scalar}, {Type::symmetric}, {Type::vector, Type::scalar, Type::matrix}};
  for (const auto& types : kinds) {
    const AnyField field = test::random_field(dimension(), 137, types, 5, has_floats());
    write_field(folder_ / "a.sol", field, options());
    expect_same(field, read_field(folder_ / "a.sol"));
  }
}

INSTANTIATE_TEST_SUITE_P(Ascii, GmfRoundTrip,
                         testing::Combine(testing::Values(Form::ascii),
                                          testing::Values(0, 1, 2, 3, 4),
                                          testing::Values(std::endian::native),
                                          testing::Values(2, 3)));
INSTANTIATE_TEST_SUITE_P(Binary, GmfRoundTrip,
                         testing::Combine(testing::Values(Form::binary),
                                          testing::Values(0, 1, 2, 3, 4),
                                          testing::Values(std::endian::little, std::endian::big),
                                          testing::Values(2, 3)));

}  // namespace
}  // namespace ductile::meshadapt::gmf_test
