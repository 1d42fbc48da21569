#include "ductile/meshadapt/mesh_arrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::mesh_from_arrays_test {
namespace {

using test::chance;
using test::Random;

/// The arrays of a mesh, with some of its facets.
template <class Index>
struct Arrays {
  std::vector<Index> elements, facets;
  std::vector<std::int32_t> facet_reference;
};

template <int Dim, class Index>
Arrays<Index> take_arrays(const AnyMesh& mesh, Random& random, double share) {
  Arrays<Index> arrays;
  for (Corners<Dim> corners : elements_in<Dim>(mesh).vertices) {
    if (chance(random, 0.3)) std::swap(corners[0], corners[1]);
    arrays.elements.insert(arrays.elements.end(), corners.begin(), corners.end());
  }
  const auto& facets = facets_in<Dim>(mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (!chance(random, share)) continue;
    arrays.facets.insert(arrays.facets.end(), facets.vertices[f].begin(), facets.vertices[f].end());
    arrays.facet_reference.push_back(100 + facets.reference[f]);
  }
  return arrays;
}

/// Number of times each facet must be listed, found by comparing all pairs of elements and facets.
template <int Dim>
std::map<Facet<Dim>, int> expected_facets(const AnyMesh& mesh) {
  std::map<Facet<Dim>, int> expected;
  const auto& reference = elements_in<Dim>(mesh).reference;
  for (const auto& [corners, around] : test::facet_elements<Dim>(mesh))
    if (around.size() == 1 || reference[around[0]] != reference[around[1]]) expected[corners] = 1;
  return expected;
}

/// Are the facet's corners in the order that is outward from an element that has it?
template <int Dim>
bool is_outward(const AnyMesh& mesh, const Facet<Dim>& facet,
                const std::vector<ElementId>& around) {
  std::array<Vector<Dim>, Dim> p;
  for (std::size_t i = 0; i < Dim; ++i) p[i] = position_in<Dim>(mesh, facet[i]);
  for (const VertexId v : elements_in<Dim>(mesh).vertices[around.front()])
    if (!contains(facet, v)) return dot(facet_normal(p), position_in<Dim>(mesh, v) - p[0]) < 0;
  return false;
}

template <int Dim, class Index>
void try_case(const AnyMesh& mesh, Random& random) {
  const runtime::Executor executor({.threads = 3});
  const double share = chance(random, 0.3) ? 0 : 0.3;
  const auto arrays = take_arrays<Dim, Index>(mesh, random, share);
  const MeshArrays<Index> given{.dimension = Dim,
                                .coordinates = mesh.coordinates,
                                .elements = arrays.elements,
                                .element_reference = elements_in<Dim>(mesh).reference,
                                .facets = arrays.facets,
                                .facet_reference = arrays.facet_reference};
  const AnyMesh made = mesh_from_arrays(executor, given);
  EXPECT_EQ(made.coordinates, mesh.coordinates);
  EXPECT_EQ(elements_in<Dim>(made).reference, elements_in<Dim>(mesh).reference);
  EXPECT_EQ(made, mesh_from_arrays(runtime::Executor({.threads = 1}), given));
  auto expected = expected_facets<Dim>(mesh);
  const auto all = test::facet_elements<Dim>(mesh);
  const auto& facets = facets_in<Dim>(made);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Facet<Dim> corners = facets.vertices[f];
    std::sort(corners.begin(), corners.end());
    ASSERT_EQ(expected[corners]--, 1) << "facet " << f;
    if (f < arrays.facet_reference.size()) {
      EXPECT_EQ(facets.reference[f], arrays.facet_reference[f]);
      EXPECT_TRUE(std::equal(facets.vertices[f].begin(), facets.vertices[f].end(),
                             &arrays.facets[f * Dim]));
    } else {
      EXPECT_EQ(facets.reference[f], 0);
      EXPECT_TRUE(is_outward<Dim>(mesh, facets.vertices[f], all.at(corners)));
    }
  }
  for (const auto& [corners, left] : expected) EXPECT_EQ(left, 0);
}

/// The shapes have holes, regions and inverted elements; indices have three widths.
TEST(MeshFromArrays, ListsTheBoundaryAndInterfacesThatAreNotGiven) {
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(60); ++seed) {
    Random random(seed);
    test::Grid grid = test::unit_grid(seed % 2 == 0 ? 2 : 3, 1 + static_cast<int>(seed % 5));
    grid.region = seed % 3 == 0 ? test::whole : test::random_regions(seed, 3, seed % 3 == 1);
    AnyMesh mesh = test::make_grid(grid);
    test::jiggle(mesh, random, 0.3);
    SCOPED_TRACE(seed);
    if (mesh.dimension == 2)
      seed % 4 == 0 ? try_case<2, int>(mesh, random) : try_case<2, long>(mesh, random);
    else
      seed % 4 == 1 ? try_case<3, int>(mesh, random) : try_case<3, long long>(mesh, random);
  }
}

TEST(MeshFromArrays, IsAMeshToAdaptWhoseFacetsKeepTheirReferences) {
  const runtime::Executor executor({.threads = 2});
  const std::vector<double> points{0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<long> triangles{0, 1, 2, 0, 2, 3}, inflow{3, 0};
  const std::vector<std::int32_t> reference{7};
  AnyMesh mesh = mesh_from_arrays<long>(executor, {.coordinates = points,
                                                   .elements = triangles,
                                                   .facets = inflow,
                                                   .facet_reference = reference});
  EXPECT_EQ(mesh.edges.reference, (std::vector<std::int32_t>{7, 0, 0, 0}));
  EXPECT_EQ(mesh.triangles.reference, (std::vector<std::int32_t>{0, 0}));
  mesh.required_edges = {0};
  const AnyField metric = metric_of(scalar_field(2, std::vector<double>(4, 0.2)), mesh);
  const AdaptedMesh adapted = adapt(executor, mesh, metric);
  EXPECT_TRUE(adapted.report.warnings.empty());
  EXPECT_TRUE(check_adapted(executor, mesh, adapted.mesh).empty());
  EXPECT_GT(adapted.mesh.triangles.size(), 40U);
  EXPECT_EQ(std::count(adapted.mesh.edges.reference.begin(), adapted.mesh.edges.reference.end(), 7),
            1);
}

/// The error for a mesh made from these arrays; empty if there is none.
std::string message(const std::vector<double>& points, const std::vector<long>& triangles,
                    const std::vector<long>& edges = {},
                    const std::vector<std::int32_t>& edge_reference = {}, int dimension = 2) {
  try {
    mesh_from_arrays<long>(runtime::Executor({.threads = 2}), {.dimension = dimension,
                                                               .coordinates = points,
                                                               .elements = triangles,
                                                               .facets = edges,
                                                               .facet_reference = edge_reference});
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

TEST(MeshFromArrays, NamesTheArrayAndTheIndexOfWhatIsWrong) {
  const std::vector<double> square{0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<long> halves{0, 1, 2, 0, 2, 3};
  EXPECT_EQ(message(square, halves), "taken");
  EXPECT_EQ(message(square, {0, 1, 2, 0, 2, 4}),
            "mesh: triangles.vertices[1] names vertex 4, but there are only 4, counted from 0");
  EXPECT_EQ(message(square, {0, 1, 2, -1, 2, 3}),
            "mesh: triangles.vertices[1] names vertex -1, but there are only 4, counted from 0");
  EXPECT_EQ(message(square, {0, 1, 1L << 32U, 0, 2, 3}),
            "mesh: triangles.vertices[0] names vertex 4294967296, but there are only 4, counted "
            "from 0");
  EXPECT_EQ(message(square, {0, 1, 2, 0, 2}),
            "mesh: expected 3 corners for each of the triangles, found 5 numbers in "
            "triangles.vertices");
  EXPECT_EQ(message(square, halves, {0, 1, 2}),
            "mesh: expected 2 corners for each of the edges, found 3 numbers in edges.vertices");
  EXPECT_EQ(message(square, halves, {0, 9}),
            "mesh: edges.vertices[0] names vertex 9, but there are only 4, counted from 0");
  EXPECT_EQ(message(square, halves, {0, 1}, {1, 2}),
            "mesh: expected a reference for each of the 1 edges, found 2 in edges.reference");
  EXPECT_EQ(message({0, 0, 1, 0, 1}, halves),
            "mesh: expected 2 coordinates for each of the 2 vertices, found 5 numbers in "
            "coordinates");
  EXPECT_EQ(message({0, 0, 1, 0, 1, 0.0 / 0.0, 0, 1}, halves).substr(0, 40),
            "mesh: expected finite coordinates, found");
  EXPECT_EQ(message(square, halves, {}, {}, 4), "mesh: expected dimension 2 or 3, found 4");
}

}  // namespace
}  // namespace ductile::meshadapt::mesh_from_arrays_test
