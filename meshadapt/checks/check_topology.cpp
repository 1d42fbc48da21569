#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/topology.hpp"

namespace ductile::meshadapt {

namespace {

template <class AllCells>
void expect_indices(const runtime::Executor& executor, const AnyMesh& mesh, const AllCells& cells,
                    const char* kind) {
  const std::size_t bad = first_bad(executor, cells.size(), [&](std::size_t i) {
    for (const std::uint32_t v : cells.vertices[i])
      if (v >= mesh.vertex_count()) return true;
    return false;
  });
  if (bad != no_index)
    throw InputError(mesh.name + ": " + kind + "[" + std::to_string(bad) +
                     "] names a vertex that is not there; expected numbers below " +
                     std::to_string(mesh.vertex_count()));
}

template <int Dim>
std::vector<std::string> check(const runtime::Executor& executor, const AnyMesh& before,
                               const AnyMesh& after) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_indices(executor, *mesh, elements_in<Dim>(*mesh), Dim == 2 ? "triangles" : "tetrahedra");
    expect_indices(executor, *mesh, facets_in<Dim>(*mesh), Dim == 2 ? "edges" : "triangles");
  }
  return topology_faults<Dim>(executor, before, after);
}

}  // namespace

std::vector<std::string> check_topology(const runtime::Executor& executor, const AnyMesh& before,
                                        const AnyMesh& after) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
  }
  if (after.dimension != before.dimension)
    throw InputError(after.name + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + before.name + ", found " + std::to_string(after.dimension));
  return before.dimension == 2 ? check<2>(executor, before, after)
                               : check<3>(executor, before, after);
}

std::vector<std::string> check_adapted(const runtime::Executor& executor, const AnyMesh& before,
                                       const AnyMesh& after, double hausdorff_tolerance) {
  auto faults = check_mesh(executor, after);
  if (faults.empty()) faults = check_domain(executor, before, after, hausdorff_tolerance);
  if (faults.empty()) faults = check_topology(executor, before, after);
  if (!faults.empty() || hausdorff_tolerance == 0) return faults;
  faults = check_boundary(executor, after);
  if (!faults.empty() && !check_boundary(executor, before).empty()) faults.clear();
  return faults;
}

}  // namespace ductile::meshadapt
