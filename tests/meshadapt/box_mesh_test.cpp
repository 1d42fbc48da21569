#include "ductile/meshadapt/any_mesh.hpp"

#include <gtest/gtest.h>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"

namespace ductile::meshadapt::box_mesh_test {
namespace {

/// Checks that each side lies at the right end of its axis and has this number of facets.
template <int Dim>
void expect_sides(const AnyMesh& mesh, const std::array<double, Dim>& extent,
                  const std::vector<std::size_t>& facets_on_side) {
  std::vector<std::size_t> found(facets_on_side.size());
  const auto& facets = facets_in<Dim>(mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto side = static_cast<std::size_t>(facets.reference[f] - 1);
    ASSERT_LT(side, found.size());
    ++found[side];
    const std::size_t axis = side / 2;
    for (const auto v : facets.vertices[f])
      EXPECT_EQ(position_in<Dim>(mesh, v).x[axis], side % 2 == 0 ? 0 : extent[axis]);
  }
  EXPECT_EQ(found, facets_on_side);
}

TEST(BoxMesh, IsAValidMeshOfTheRectangleWhoseSidesAreTold) {
  const runtime::Executor executor({.threads = 2});
  const AnyMesh mesh = box_mesh<2>({2, 0.5}, {4, 3});
  EXPECT_TRUE(check_mesh(executor, mesh).empty());
  EXPECT_EQ(mesh.triangles.size(), 24U);
  expect_sides<2>(mesh, {2, 0.5}, {3, 3, 4, 4});
  double area = 0;
  for (const double share : make_fixed_mesh<2>(executor, mesh).volume_of) area += share;
  EXPECT_NEAR(area, 1, 1e-14);
}

TEST(BoxMesh, IsAValidMeshOfTheBoxWhoseSidesAreTold) {
  const runtime::Executor executor({.threads = 2});
  const AnyMesh mesh = box_mesh({1, 2, 3}, {2, 3, 4});
  EXPECT_TRUE(check_mesh(executor, mesh).empty());
  EXPECT_EQ(mesh.tetrahedra.size(), 144U);
  expect_sides<3>(mesh, {1, 2, 3}, {24, 24, 16, 16, 12, 12});
  double volume = 0;
  for (const double share : make_fixed_mesh<3>(executor, mesh).volume_of) volume += share;
  EXPECT_NEAR(volume, 6, 1e-13);
}

TEST(BoxMesh, RefusesBoxesWithoutExtentOrCells) {
  EXPECT_THROW(box_mesh<2>({1, 0}, {1, 1}), InputError);
  EXPECT_THROW(box_mesh<2>({1, 1}, {0, 1}), InputError);
  EXPECT_THROW(box_mesh({1, 1, -1}, {1, 1, 1}), InputError);
  EXPECT_THROW(box_mesh({1, 1, 1.0 / 0.0}, {1, 1, 1}), InputError);
  EXPECT_THROW(box_mesh({1, 1, 1}, {2000, 2000, 2000}), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::box_mesh_test
