/// @file
/// The check that the boundary of a mesh does not cross itself.
#include "checks/problems.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "geometry/crossing_facets.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/indices.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
std::vector<std::string> check(const runtime::Executor& executor, const AnyMesh& mesh) {
  const CrossingFacets<Dim> crossing(executor, mesh);
  Problems problems(executor);
  problems.expect_none(
      crossing.size(), [&](std::size_t f) { return crossing.partner_of(f) != no_index; },
      [&](std::size_t f) {
        return entity(facet_name<Dim>(), f) + " crosses " +
               entity(facet_name<Dim>(), crossing.partner_of(f));
      });
  return problems.take();
}

}  // namespace

std::vector<std::string> check_boundary(const runtime::Executor& executor, const AnyMesh& mesh) {
  expect_coordinates(mesh);
  if (mesh.dimension == 2)
    expect_vertices(mesh, mesh.edges, "edges.vertices", "edge");
  else
    expect_vertices(mesh, mesh.triangles, "triangles.vertices", "triangle");
  return mesh.dimension == 2 ? check<2>(executor, mesh) : check<3>(executor, mesh);
}

}  // namespace ductile::meshadapt
