#include "operators/swap.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

#include "ductile/meshadapt/make_mesh.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt {
namespace {

const runtime::Executor executor({.threads = 2});

/// A mesh in the Euclidean metric.
template <int Dim>
Mesh<Dim> mesh_of(std::initializer_list<Vector<Dim>> points,
                  std::initializer_list<Corners<Dim>> elements) {
  AnyMesh any;
  any.dimension = Dim;
  for (const Vector<Dim>& point : points) {
    any.coordinates.insert(any.coordinates.end(), point.x.begin(), point.x.end());
    any.vertex_reference.push_back(0);
  }
  for (const Corners<Dim>& corners : elements) {
    if constexpr (Dim == 2)
      any.triangles.add(corners, 1);
    else
      any.tetrahedra.add(corners, 1);
  }
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  auto mesh = make_mesh<Dim>(executor, any, {.complete_boundary = true}, neighbours, warnings);
  Metric<Dim> unit;
  for (std::size_t i = 0, k = 0; i < Dim; k += ++i + 1) unit.m[k] = 1;
  for (auto& site : mesh.site_of) site = make_site(site.position, unit);
  update_shapes(executor, mesh);
  return mesh;
}

template <int Dim>
runtime::UnsetVector<Swappable> improvements(Mesh<Dim>& mesh, std::uint32_t after = 0) {
  return Swap<Dim>::improvements(executor, mesh, after, 0.9);
}

TEST(Swap, FlipsTheLongDiagonalOfAKiteOnce) {
  for (const bool turned : {false, true}) {
    const Corners<2> above{0, 1, 3}, below{0, 2, 1};
    auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -0.4}}, {{0.1, 0.5}}},
                           {turned ? below : above, turned ? above : below});
    const auto found = improvements(mesh);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
    mesh.epoch = 5;
    EXPECT_TRUE(improvements(mesh, 4).empty());
  }
}

TEST(Swap, FlipsFromTheOnlyPoorTriangle) {
  auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -1.6}}, {{0, 0.2}}}, {{0, 1, 3}, {0, 2, 1}});
  EXPECT_EQ(improvements(mesh).size(), 1U);
}

TEST(Swap, LeavesGoodTrianglesAlone) {
  auto mesh = mesh_of<2>({{{-1, 0}}, {{1, 0}}, {{0, -1.7}}, {{0, 1.7}}}, {{0, 1, 3}, {0, 2, 1}});
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, RemovesALongEdgeInsideThreeTetrahedra) {
  auto mesh =
      mesh_of<3>({{{0, 0, -1.2}}, {{0, 0, 1.2}}, {{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}},
                 {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}});
  const auto found = improvements(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
  EXPECT_EQ(found[0].c, none);
}

TEST(Swap, RemovesALongEdgeOfAFlatBoundary) {
  auto mesh = mesh_of<3>({{{-1, 0, 0}}, {{1, 0, 0}}, {{0, -0.6, 0}}, {{0, 0.6, 0}}, {{0, 0, 0.8}}},
                         {{0, 1, 3, 4}, {0, 2, 1, 4}});
  const auto found = improvements(mesh);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::pair(found[0].a, found[0].b), std::pair(VertexId{0}, VertexId{1}));
  EXPECT_EQ(found[0].c, none);
}

TEST(Swap, LeavesTheEdgesOfASingleTetrahedronAlone) {
  auto mesh = mesh_of<3>({{{0, 0, 0}}, {{2, 0, 0}}, {{0, 0.5, 0}}, {{0, 0, 0.5}}}, {{0, 1, 2, 3}});
  EXPECT_TRUE(improvements(mesh).empty());
}

TEST(Swap, PiercesTheLargeFaceOfFlatTetrahedra) {
  for (const double below : {-0.3, -0.2, -0.9}) {
    auto mesh = mesh_of<3>(
        {{{1, 0, 0}}, {{-0.5, 0.9, 0}}, {{-0.5, -0.9, 0}}, {{0, 0, 0.25}}, {{0, 0, below}}},
        {{0, 1, 2, 3}, {0, 2, 1, 4}});
    const auto found = improvements(mesh);
    ASSERT_EQ(found.size(), 1U) << below;
    EXPECT_EQ((std::array{found[0].a, found[0].b, found[0].c}), (std::array<VertexId, 3>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace ductile::meshadapt
