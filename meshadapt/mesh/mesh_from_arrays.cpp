#include "ductile/meshadapt/mesh_arrays.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/first_bad.hpp"
#include "core/orientation.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/indices.hpp"
#include "mesh/scale.hpp"
#include "mesh/sorted_cells.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The given cells of one shape.
template <class Index>
struct GivenCells {
  std::span<const Index> corners;
  std::span<const std::int32_t> reference;
};

/// The given references, or 0 for each of so many entities.
std::vector<std::int32_t> references(std::span<const std::int32_t> given, std::size_t count) {
  if (given.empty()) return std::vector<std::int32_t>(count, 0);
  return {given.begin(), given.end()};
}

/// The array of an AnyMesh for cells with so many corners: "triangles".
template <std::size_t N>
std::string array_of() {
  return N == 2 ? "edges" : N == 3 ? "triangles" : "tetrahedra";
}

/// Throws InputError unless numbers name vertices of the mesh.
template <std::size_t N, class Index>
void expect_indices(const Executor& executor, const AnyMesh& mesh, std::span<const Index> corners) {
  const auto is_bad = [&](std::size_t i) {
    return corners[i] < 0 || static_cast<std::uint64_t>(corners[i]) >= mesh.vertex_count();
  };
  const std::size_t bad = first_bad(executor, corners.size(), is_bad);
  if (bad == no_index) return;
  throw InputError(name_of(mesh) + ": " + array_of<N>() + ".vertices[" + std::to_string(bad / N) +
                   "] names vertex " + std::to_string(corners[bad]) + ", but there are only " +
                   std::to_string(mesh.vertex_count()) + ", counted from 0");
}

template <int N, class Index>
void take_cells(const Executor& executor, const GivenCells<Index>& given, const AnyMesh& mesh,
                Cells<N>& cells) {
  constexpr auto corners = static_cast<std::size_t>(N);
  if (given.corners.size() % corners != 0)
    throw InputError(name_of(mesh) + ": expected " + std::to_string(N) +
                     " corners for each of the " + array_of<corners>() + ", found " +
                     std::to_string(given.corners.size()) + " numbers in " + array_of<corners>() +
                     ".vertices");
  expect_indices<corners>(executor, mesh, given.corners);
  const std::size_t count = given.corners.size() / corners;
  cells.vertices = runtime::make_vector<std::array<std::uint32_t, corners>>(executor, count);
  runtime::parallel_for(executor, count, [&](std::size_t i) {
    for (std::size_t k = 0; k < corners; ++k)
      cells.vertices[i][k] = static_cast<std::uint32_t>(given.corners[i * corners + k]);
  });
  cells.reference = references(given.reference, count);
}

/// The facets to be listed, from the elements of lower numbers, in order.
template <int Dim>
runtime::UnsetVector<ElementFacet> unlisted_boundary(const Executor& executor,
                                                     const AnyMesh& mesh) {
  const auto listed = sorted_cells(executor, facets_in<Dim>(mesh).vertices);
  const auto& reference_of = elements_in<Dim>(mesh).reference;
  const std::vector<std::uint32_t> region_of(reference_of.begin(), reference_of.end());
  const AdjacentMesh adjacent(executor, mesh);
  const Adjacency<Dim>& adjacency = adjacent.adjacency<Dim>();
  return runtime::parallel_collect<ElementFacet>(
      executor, reference_of.size(), [&](std::size_t e, auto&& append) {
        for (ElementFacet at{static_cast<ElementId>(e), 0}; at.facet <= Dim; ++at.facet)
          if (adjacency.is_first(at) &&
              adjacency.on_region_boundary(at.element, at.facet, region_of) &&
              find_cell<Dim>(listed, facet_of<Dim>(adjacency.corners_of[e], at.facet)) == none)
            append(at);
      });
}

/// The corners of an element's facet, oriented outwards.
template <int Dim>
Facet<Dim> outward(const AnyMesh& mesh, const ElementFacet& at) {
  const Corners<Dim>& corners = elements_in<Dim>(mesh).vertices[at.element];
  Facet<Dim> result = facet_of<Dim>(corners, at.facet);
  if (orientation<Dim>(points_in<Dim>(mesh, corners)) < 0) std::swap(result[0], result[1]);
  return result;
}

template <int Dim>
std::size_t list_boundary_in(const Executor& executor, AnyMesh& mesh) {
  expect_references(mesh);
  expect_all_vertices(mesh);
  expect_finite_coordinates(executor, mesh);
  const auto found = unlisted_boundary<Dim>(executor, mesh);
  for (const ElementFacet& at : found) facets_in<Dim>(mesh).add(outward<Dim>(mesh, at), 0);
  return found.size();
}

}  // namespace

template <std::signed_integral Index>
AnyMesh mesh_from_arrays(const Executor& executor, const MeshArrays<Index>& arrays) {
  AnyMesh mesh;
  mesh.dimension = arrays.dimension;
  mesh.name = arrays.name;
  if (mesh.dimension != 2 && mesh.dimension != 3)
    throw InputError(name_of(mesh) + ": expected dimension 2 or 3, found " +
                     std::to_string(mesh.dimension));
  mesh.coordinates.assign(arrays.coordinates.begin(), arrays.coordinates.end());
  mesh.vertex_reference = references(
      arrays.vertex_reference, mesh.coordinates.size() / static_cast<std::size_t>(mesh.dimension));
  expect_coordinates(mesh);
  if (mesh.vertex_count() >= none)
    throw InputError(name_of(mesh) + ": expected fewer than " + std::to_string(none) +
                     " vertices, found " + std::to_string(mesh.vertex_count()));
  const GivenCells<Index> elements{arrays.elements, arrays.element_reference};
  const GivenCells<Index> facets{arrays.facets, arrays.facet_reference};
  if (mesh.dimension == 2 || arrays.is_surface) {
    take_cells(executor, elements, mesh, mesh.triangles);
    take_cells(executor, facets, mesh, mesh.edges);
  } else {
    take_cells(executor, elements, mesh, mesh.tetrahedra);
    take_cells(executor, facets, mesh, mesh.triangles);
  }
  list_boundary(executor, mesh);
  return mesh;
}

std::size_t list_boundary(const Executor& executor, AnyMesh& mesh) {
  expect_coordinates(mesh);
  if (is_surface(mesh)) return 0;  // whose rims need no listing
  return mesh.dimension == 2 ? list_boundary_in<2>(executor, mesh)
                             : list_boundary_in<3>(executor, mesh);
}

template AnyMesh mesh_from_arrays(const Executor&, const MeshArrays<int>&);
template AnyMesh mesh_from_arrays(const Executor&, const MeshArrays<long>&);
template AnyMesh mesh_from_arrays(const Executor&, const MeshArrays<long long>&);

}  // namespace ductile::meshadapt
