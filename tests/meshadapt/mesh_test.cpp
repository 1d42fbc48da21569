#include "mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "adapt/take_apart.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/make_mesh.hpp"
#include "support/check_structure.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::mesh_test {
namespace {

using runtime::Executor;

template <class Dimension>
class MeshIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MeshIn, Dimensions);

template <int Dim>
AnyMesh shuffled_box(int cells = 5) {
  test::Grid grid = test::unit_grid(Dim, cells);
  grid.region = test::two_halves(cells);
  AnyMesh any = test::make_grid(grid);
  if (Dim == 3) test::list_ridges(any);
  test::Random random(2);
  if constexpr (Dim == 2)
    std::shuffle(any.triangles.vertices.begin(), any.triangles.vertices.end(), random);
  test::jiggle(any, random, 0.2);
  any.required_vertices = {7};
  return any;
}

template <int Dim>
Mesh<Dim> made(const AnyMesh& any, int threads) {
  const Executor executor({.threads = threads});
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  MakeMeshOptions options;
  Mesh<Dim> mesh = make_mesh<Dim>(executor, any, options, neighbours, warnings);
  for (auto& site : mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
  update_qualities(executor, mesh);
  return mesh;
}

TYPED_TEST(MeshIn, RenumberingKeepsEverything) {
  constexpr int Dim = TypeParam::value;
  test::Grid grid = test::unit_grid(Dim, 4);
  AnyMesh any = test::make_grid(grid);
  Mesh<Dim> mesh = made<Dim>(any, 2);
  const Executor executor({.threads = 2});
  renumber(executor, mesh);
  const auto faults = check_mesh(executor, mesh);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  const AnyMesh back = take_apart(executor, std::move(mesh)).mesh;
  const auto changes = test::changes_of_what_is_kept(any, back);
  EXPECT_TRUE(changes.empty()) << test::joined(changes);
  EXPECT_EQ(back.vertex_count(), any.vertex_count());
}

TYPED_TEST(MeshIn, RenumberingDropsWhatIsGoneAndBringsNeighboursTogether) {
  constexpr int Dim = TypeParam::value;
  AnyMesh any = shuffled_box<Dim>();
  any.vertex_reference.push_back(0);  // belongs to no element
  any.coordinates.resize(any.coordinates.size() + Dim, 0.1);
  Mesh<Dim> mesh = made<Dim>(any, 2);
  mesh.grow(runtime::Executor({.threads = 2}), mesh.vertex_slots() + 5, mesh.element_slots() + 5);
  for (ElementId e = mesh.element_slots() - 5; e < mesh.element_slots(); ++e)
    mesh.corners_of[e].fill(none);
  const Executor executor({.threads = 2});
  renumber(executor, mesh);
  EXPECT_EQ(mesh.vertex_slots(), any.vertex_count() - 1);
  EXPECT_EQ(mesh.element_slots(), any.triangles.size() * (Dim == 2) + any.tetrahedra.size());
  const auto faults = check_mesh(executor, mesh);
  EXPECT_TRUE(faults.empty()) << test::joined(faults);
  for (ElementId e = 1; e < mesh.element_slots(); ++e)
    EXPECT_LE(*std::min_element(mesh.corners_of[e - 1].begin(), mesh.corners_of[e - 1].end()),
              *std::min_element(mesh.corners_of[e].begin(), mesh.corners_of[e].end()));
}

TYPED_TEST(MeshIn, RenumberingIsTheSameAtEachThreadCount) {
  constexpr int Dim = TypeParam::value;
  const AnyMesh any = shuffled_box<Dim>(Dim == 2 ? 80 : 12);  // large enough to be shared
  Mesh<Dim> first = made<Dim>(any, 1);
  renumber(Executor({.threads = 1}), first);
  for (const int threads : {2, 3, 8}) {
    Mesh<Dim> mesh = made<Dim>(any, threads);
    renumber(Executor({.threads = threads}), mesh);
    EXPECT_EQ(mesh.corners_of, first.corners_of);
    EXPECT_EQ(mesh.patches_of, first.patches_of);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
      EXPECT_EQ(mesh.site_of[v].position, first.site_of[v].position);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      const auto list = mesh.elements_of.of(v), of_first = first.elements_of.of(v);
      EXPECT_TRUE(std::equal(list.begin(), list.end(), of_first.begin(), of_first.end()));
      EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    }
  }
}

template <int Dim>
struct WithNeighbours {
  Mesh<Dim> mesh;
  Neighbours<Dim> neighbours;
};

template <int Dim>
WithNeighbours<Dim> renumbered(const Executor& executor, const AnyMesh& any) {
  WithNeighbours<Dim> result;
  std::vector<std::string> warnings;
  result.mesh = make_mesh<Dim>(executor, any, {}, result.neighbours, warnings);
  for (auto& site : result.mesh.site_of) site = make_site(site.position, isotropic<Dim>(1));
  update_qualities(executor, result.mesh);
  renumber(executor, result.mesh, result.neighbours);
  return result;
}

TYPED_TEST(MeshIn, RenumberingWhatIsInOrderOrNearlySoGivesTheSame) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  const AnyMesh shuffled = shuffled_box<Dim>(Dim == 2 ? 30 : 7);
  const AnyMesh in_order = take_apart(executor, renumbered<Dim>(executor, shuffled).mesh).mesh;
  const auto expected = renumbered<Dim>(executor, in_order);
  EXPECT_EQ(expected.mesh.corners_of.size(), elements_in<Dim>(in_order).size());
  for (std::size_t e = 0; e < expected.mesh.element_slots(); ++e)
    EXPECT_EQ(expected.mesh.corners_of[e], elements_in<Dim>(in_order).vertices[e]);

  AnyMesh moved = in_order;  // the first element comes last
  auto& elements = elements_in<Dim>(moved).vertices;
  std::rotate(elements.begin(), elements.begin() + 1, elements.end());
  AnyMesh named = in_order;  // the last two vertices change their numbers
  const auto last = static_cast<VertexId>(named.vertex_count() - 1);
  for (int k = 0; k < Dim; ++k)
    std::swap(named.coordinates[last * Dim + k], named.coordinates[(last - 1) * Dim + k]);
  const auto rename = [&](auto& cells) {
    for (auto& corners : cells.vertices)
      for (VertexId& v : corners) v = v == last ? last - 1 : v == last - 1 ? last : v;
  };
  rename(named.edges), rename(named.triangles), rename(named.tetrahedra);
  for (const AnyMesh& any : std::vector{shuffled, moved, named}) {
    const auto result = renumbered<Dim>(executor, any);
    EXPECT_TRUE(check_mesh(executor, result.mesh).empty());
    ASSERT_EQ(result.mesh.vertex_slots(), expected.mesh.vertex_slots());
    for (VertexId v = 0; v < result.mesh.vertex_slots(); ++v)
      EXPECT_EQ(result.mesh.site_of[v].position, expected.mesh.site_of[v].position);
    for (ElementId e = 0; e < result.mesh.element_slots(); ++e)
      for (int i = 0; i <= Dim; ++i) {
        const auto facet = static_cast<std::size_t>(i);
        const ElementId other = result.neighbours[e][facet];
        EXPECT_EQ(other, neighbour(result.mesh, e, i));
      }
  }
}

TYPED_TEST(MeshIn, RenumberingDropsVerticesThatComeFirst) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (VertexId gone = 0; gone < 20; ++gone) {
    Mesh<Dim> mesh = made<Dim>(shuffled_box<Dim>(), 1);
    for (VertexId v = 0; v <= gone; ++v)
      for (const ElementId e : mesh.elements_of.of(v)) mesh.corners_of[e].fill(none);
    rebuild_elements_of(executor, mesh);
    std::size_t left = 0;
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) left += mesh.vertex_alive(v);
    renumber(executor, mesh);
    EXPECT_EQ(mesh.vertex_slots(), left);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) EXPECT_TRUE(mesh.vertex_alive(v));
  }
}

TYPED_TEST(MeshIn, ListsAreTheSameAtEachThreadCount) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> mesh = made<Dim>(shuffled_box<Dim>(Dim == 2 ? 80 : 12), 1);
  std::vector<std::vector<ElementId>> expected(mesh.vertex_slots());
  for (ElementId e = 0; e < mesh.element_slots(); ++e) {
    if (e % 7 == 0) mesh.corners_of[e].fill(none);
    if (mesh.alive(e))
      for (const VertexId v : mesh.corners_of[e]) expected[v].push_back(e);
  }
  for (const int threads : {1, 2, 3, 8}) {
    rebuild_elements_of(Executor({.threads = threads}), mesh);
    for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
      const auto list = mesh.elements_of.of(v);
      EXPECT_EQ(std::vector(list.begin(), list.end()), expected[v]);
    }
  }
}

/// A mesh with regions, ridges, corners and required entities, numbered row by row. Every seventh
/// of the elements inside its regions is deleted.
template <int Dim>
Mesh<Dim> with_gaps() {
  const int cells = Dim == 2 ? 40 : 10;
  test::Grid grid = test::unit_grid(Dim, cells);
  grid.region = test::two_halves(cells);
  AnyMesh any = test::make_grid(grid);
  if (Dim == 3) test::list_ridges(any);
  any.required_vertices = {11};
  (Dim == 2 ? any.required_edges : any.required_triangles) = {7};
  (Dim == 2 ? any.required_triangles : any.required_tetrahedra) = {3, 5};
  Mesh<Dim> mesh = made<Dim>(any, 2);
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    mesh.site_of[v] = make_site(mesh.site_of[v].position, isotropic<Dim>(1 + 0.5 / (1 + v)));
  for (ElementId e = 0; e < mesh.element_slots(); e += 7) {
    const auto& patches = mesh.patches_of[e];
    if (std::all_of(patches.begin(), patches.end(), [](PatchId patch) { return patch == 0; }))
      mesh.corners_of[e].fill(none);
  }
  rebuild_elements_of(Executor({.threads = 1}), mesh);
  return mesh;
}

/// Expects that the arrays equal those of a mesh that has been renumbered.
template <int Dim>
void expect_same(const MeshWithMetric& apart, const Mesh<Dim>& mesh) {
  const AnyMesh& any = apart.mesh;
  EXPECT_EQ(any.dimension, Dim);
  ASSERT_EQ(any.vertex_count(), mesh.vertex_slots());
  ASSERT_EQ(apart.metric.vertex_count, mesh.vertex_slots());
  std::vector<std::uint32_t> corners, required;
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v) {
    const Site<Dim>& site = mesh.site_of[v];
    EXPECT_TRUE(std::equal(site.position.x.begin(), site.position.x.end(),
                           any.coordinates.begin() + v * Dim));
    EXPECT_TRUE(std::equal(site.metric.m.begin(), site.metric.m.end(),
                           apart.metric.values.begin() + v * Metric<Dim>::size));
    EXPECT_EQ(any.vertex_reference[v], mesh.reference_of[v]);
    if (mesh.kind_of[v].corner) corners.push_back(v);
    if (mesh.kind_of[v].required) required.push_back(v);
  }
  EXPECT_EQ(any.corners, corners);
  EXPECT_EQ(any.required_vertices, required);
  const Cells<Dim + 1>& cells = elements_in<Dim>(any);
  ASSERT_EQ(cells.size(), mesh.element_slots());
  required.clear();
  Cells<Dim> facets;
  for (ElementId e = 0; e < mesh.element_slots(); ++e) {
    EXPECT_EQ(cells.vertices[e], mesh.corners_of[e]);
    EXPECT_EQ(cells.reference[e], mesh.regions[mesh.region_of[e]].reference);
    if (mesh.required_element(e)) required.push_back(e);
    for (int i = 0; i <= Dim; ++i) {
      const PatchId patch = mesh.patches_of[e][static_cast<std::size_t>(i)];
      const ElementId other = neighbour(mesh, e, i);
      if (patch != 0 && mesh.patches[patch].listed && (other == none || other > e))
        facets.add(facet_of<Dim>(mesh.corners_of[e], i), mesh.patches[patch].reference);
    }
  }
  EXPECT_EQ(Dim == 2 ? any.required_triangles : any.required_tetrahedra, required);
  EXPECT_TRUE(facets_in<Dim>(any) == facets);
  if constexpr (Dim == 2) return;
  Cells<2> edges;
  std::vector<std::uint32_t> ridges;
  for (VertexId v = 0; v < mesh.vertex_slots(); ++v)
    for (const CurveLink& link : mesh.links_of.of(v)) {
      const Curve& curve = mesh.curves[link.curve];
      if (link.to < v || !curve.listed) continue;
      if (curve.ridge) ridges.push_back(static_cast<std::uint32_t>(edges.size()));
      edges.add({v, link.to}, curve.reference);
    }
  EXPECT_TRUE(any.edges == edges);
  EXPECT_EQ(any.ridges, ridges);
}

TYPED_TEST(MeshIn, TakingItApartGivesWhatItsArraysHoldInOrder) {
  constexpr int Dim = TypeParam::value;
  Mesh<Dim> ordered = with_gaps<Dim>();
  renumber(Executor({.threads = 2}), ordered);
  const MeshWithMetric first = take_apart(Executor({.threads = 1}), with_gaps<Dim>());
  expect_same(first, ordered);
  EXPECT_LT(elements_in<Dim>(first.mesh).size(), with_gaps<Dim>().element_slots());
  EXPECT_FALSE(Dim == 2 ? first.mesh.required_edges.empty()
                        : first.mesh.required_triangles.empty() || first.mesh.ridges.empty());
  for (const int threads : {2, 3, 8}) {
    const MeshWithMetric apart = take_apart(Executor({.threads = threads}), with_gaps<Dim>());
    EXPECT_TRUE(apart.mesh == first.mesh) << threads;
    EXPECT_EQ(apart.metric.values, first.metric.values);
  }
}

TYPED_TEST(MeshIn, TakingApartWhatIsInOrderChangesNoNumber) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  Mesh<Dim> ordered = with_gaps<Dim>();
  renumber(executor, ordered);
  EXPECT_TRUE(take_apart(executor, std::move(ordered)).mesh ==
              take_apart(executor, with_gaps<Dim>()).mesh);
}

TYPED_TEST(MeshIn, NeighboursAreMutual) {
  constexpr int Dim = TypeParam::value;
  const Mesh<Dim> mesh = made<Dim>(shuffled_box<Dim>(), 1);
  for (ElementId e = 0; e < mesh.element_slots(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const ElementId other = neighbour(mesh, e, i);
      if (other == none) continue;
      bool back = false;
      for (int k = 0; k <= Dim; ++k) back = back || neighbour(mesh, other, k) == e;
      EXPECT_TRUE(back);
    }
}

}  // namespace
}  // namespace ductile::meshadapt::mesh_test
