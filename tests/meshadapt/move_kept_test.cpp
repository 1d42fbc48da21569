/// @file
/// What a motion may not change: Mmg's -lag 0 and 1, and required elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/move.hpp"
#include "move_support.hpp"
#include "support/broken_input.hpp"

namespace ductile::meshadapt::move_test {
namespace {

using test::Random;
using test::uniform;

template <class Dimension>
class MoveKeeps : public testing::Test {};
TYPED_TEST_SUITE(MoveKeeps, test::Dimensions, );

/// Mmg's -lag 0 and 1: without adaptation elements keep their corners; without insertion vertices
/// keep their number.
TYPED_TEST(MoveKeeps, WhatMayNotChangeDoesNot) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Random random(6);
  int swapped = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const AnyMesh mesh = box_with_ball<Dim>(executor, uniform(random, 0.35, 0.4),
                                            uniform(random, 0.12, 0.2), Dim == 2 ? 16 : 8);
    const Vector<Dim> way = along_x<Dim>(uniform(random, 0.25, 0.35), uniform(random, -0.1, 0.1));
    const auto displacement =
        displacement_of<Dim>(mesh, [&](const Vector<Dim>& p) { return p + way; });
    const MovedMesh still =
        move(executor, mesh, displacement, {.remeshes = false, .keep_partial = true});
    EXPECT_EQ(still.report.adaptations, 0);
    EXPECT_EQ(test::joined(check_mesh(executor, still.mesh)), "");
    EXPECT_EQ(elements_in<Dim>(still.mesh), elements_in<Dim>(mesh));
    EXPECT_EQ(facets_in<Dim>(still.mesh), facets_in<Dim>(mesh));
    const MovedMesh swaps = move(executor, mesh, displacement,
                                 {.remesh_below = 0.5, .insert = false, .keep_partial = true});
    EXPECT_EQ(test::joined(check_mesh(executor, swaps.mesh)), "");
    EXPECT_EQ(swaps.mesh.vertex_count(), mesh.vertex_count());
    EXPECT_EQ(facets_in<Dim>(swaps.mesh).size(), facets_in<Dim>(mesh).size());
    EXPECT_GE(swaps.report.share, still.report.share);
    swapped += std::ranges::count(swaps.origins.element, none) > 0;
  }
  EXPECT_GT(swapped, 2);
}

/// Bodies that pass close to required elements leave these where they are.
TYPED_TEST(MoveKeeps, RequiredElementsStay) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  AnyMesh mesh = box_with_ball<Dim>(executor, 0.3, 0.15, Dim == 2 ? 20 : 8);
  auto& required = Dim == 2 ? mesh.required_triangles : mesh.required_tetrahedra;
  std::vector<std::array<Vector<Dim>, Dim + 1>> expected, found;
  const auto points = [&](const AnyMesh& of, std::size_t e) {
    std::array<Vector<Dim>, Dim + 1> result;
    for (std::size_t i = 0; i <= Dim; ++i)
      result[i] = position_in<Dim>(of, elements_in<Dim>(of).vertices[e][i]);
    return result;
  };
  const auto fixed = make_fixed_mesh<Dim>(executor, mesh);
  for (ElementId e = 0; e < fixed.element_count(); ++e) {
    Vector<Dim> middle;
    for (const auto& point : fixed.points(e)) middle += 1.0 / (Dim + 1) * point;
    Vector<Dim> centre = all<Dim>(0.5);
    centre[1] = 0.85;
    if (norm(middle - centre) < 0.12) required.push_back(e);
  }
  ASSERT_GT(required.size(), 5U);
  for (const std::uint32_t e : required) expected.push_back(points(mesh, e));
  const MovedMesh moved =
      move(executor, mesh,
           displacement_of<Dim>(mesh, [](const Vector<Dim>& p) { return p + along_x<Dim>(0.4); }));
  for (const std::uint32_t e :
       Dim == 2 ? moved.mesh.required_triangles : moved.mesh.required_tetrahedra)
    found.push_back(points(moved.mesh, e));
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_TRUE(std::ranges::is_permutation(found[i], expected[i])) << i;
}

}  // namespace
}  // namespace ductile::meshadapt::move_test
