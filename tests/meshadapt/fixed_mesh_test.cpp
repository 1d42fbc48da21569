#include "ductile/meshadapt/fixed_mesh.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/determinant.hpp"
#include "ductile/meshadapt/error.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::fixed_mesh_test {
namespace {

using runtime::Executor;
using test::Random;

template <class Dimension>
class FixedMeshIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FixedMeshIn, Dimensions, );

template <int Dim>
AnyMesh jiggled_grid(int n) {
  AnyMesh any = test::make_grid(test::unit_grid(Dim, n));
  Random random(1);
  test::jiggle(any, random, 0.3);
  return any;
}

TYPED_TEST(FixedMeshIn, KnowsVolumesNeighboursAndTheBoundary) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = jiggled_grid<Dim>(5);
  const auto mesh = make_fixed_mesh<Dim>(Executor({.threads = 2}), any);
  double volume = 0, shares = 0;
  std::size_t facets_outside = 0;
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    volume += mesh.volume_of[e];
    for (const ElementId other : mesh.neighbour_of[e]) {
      facets_outside += other == none;
      EXPECT_TRUE(other == none || contains(mesh.neighbour_of[other], e));
    }
  }
  for (VertexId v = 0; v < mesh.vertex_count(); ++v) {
    shares += mesh.share_of[v];
    bool outside = false;
    for (const double x : mesh.position_of[v].x) outside = outside || x == 0 || x == 1;
    EXPECT_EQ(mesh.on_boundary[v] != 0, outside);
    for (const ElementId e : mesh.elements_of(v)) EXPECT_TRUE(contains(mesh.corners_of[e], v));
  }
  EXPECT_NEAR(volume, 1, 1e-12);
  EXPECT_NEAR(shares, 1, 1e-12);
  EXPECT_EQ(facets_outside, test::facets<Dim>(any).size());
}

TYPED_TEST(FixedMeshIn, DifferentiatesAndIntegratesLinearFunctionsExactly) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 3});
  const auto mesh = make_fixed_mesh<Dim>(executor, jiggled_grid<Dim>(4));
  Vector<Dim> slope;
  double mean = 2;
  for (int i = 0; i < Dim; ++i) {
    slope[i] = i + 1;
    mean += slope[i] / 2;
  }
  std::vector<double> value_of;
  for (const Vector<Dim>& p : mesh.position_of) value_of.push_back(2 + dot(slope, p));
  EXPECT_NEAR(integral<Dim>(executor, mesh, value_of), mean, 1e-12);
  for (ElementId e = 0; e < mesh.element_count(); ++e) {
    const auto hat = hat_gradients<Dim>(mesh.points(e));
    Vector<Dim> gradient;
    for (std::size_t i = 0; i <= Dim; ++i) gradient += value_of[mesh.corners_of[e][i]] * hat[i];
    EXPECT_LT(norm(gradient - slope), 1e-11);
  }
}

TYPED_TEST(FixedMeshIn, IntegratesOnlyWhatHasAValueAtEachVertex) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const auto mesh = make_fixed_mesh<Dim>(executor, test::make_grid(test::unit_grid(Dim, 2)));
  EXPECT_THROW(integral<Dim>(executor, mesh, std::vector<double>(mesh.vertex_count() - 1)),
               InputError);
}

TYPED_TEST(FixedMeshIn, TurnsInvertedElementsAndRefusesBadOnes) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  AnyMesh any = test::make_grid(test::unit_grid(Dim, 2));
  auto& cells = [&]() -> auto& {
    if constexpr (Dim == 2)
      return any.triangles;
    else
      return any.tetrahedra;
  }
  ();
  std::swap(cells.vertices[3][0], cells.vertices[3][1]);
  EXPECT_GT(plain_determinant(make_fixed_mesh<Dim>(executor, any).points(3)), 0);
  const std::uint32_t kept = std::exchange(cells.vertices[3][0], cells.vertices[3][1]);
  EXPECT_THROW(make_fixed_mesh<Dim>(executor, any), InputError);
  cells.vertices[3][0] = 1000000;
  EXPECT_THROW(make_fixed_mesh<Dim>(executor, any), InputError);
  cells.vertices[3][0] = kept;
  EXPECT_THROW(make_fixed_mesh<5 - Dim>(executor, any), InputError);
  cells = {};
  EXPECT_THROW(make_fixed_mesh<Dim>(executor, any), InputError);
}

}  // namespace
}  // namespace ductile::meshadapt::fixed_mesh_test
