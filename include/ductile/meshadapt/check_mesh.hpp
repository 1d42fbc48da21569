/// @file
/// check_mesh: reports faults of a mesh: whether one to be written is a mesh at all, and whether
/// one being adapted is still consistent.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Faults of a mesh, one line for each kind, naming the first entity (numbered from 1, as in a
/// file) and their number; empty if there are none. Checks: indices in range, every vertex used,
/// every element with a positive volume (exactly), no facet with more than two elements or with two
/// on one side, every boundary facet listed once, and no listed facet missing in the mesh. Linear
/// in the mesh. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_mesh(const runtime::Executor& executor, const AnyMesh& mesh);

/// Differences between the domains of `after` and `before`, one line each; empty if there are none.
/// Adaptation must keep the measure (area or volume) of the whole and of the elements of each
/// reference, and the length or area of listed boundary facets and interfaces by reference. They
/// must agree to 1e-9 of the total plus the error of the boundary's position, which matters in thin
/// domains and far from the origin: the greater of 2e-10 of the extent and the rounding of
/// coordinates. With a surface tolerance (see MakeMeshOptions) the measures may differ by as much
/// as boundaries that far away allow, and boundaries only have to exist. The boundary of `after`
/// may not touch itself, at vertices in 2D or along edges in 3D, where that of `before` did not.
/// Boundary that `before` does not list has reference 0 if it lists some. Throws InputError unless
/// both meshes have the same dimension, all coordinates and references, and only existing vertices.
/// Takes n log n in the facets, otherwise linear. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_domain(const runtime::Executor& executor, const AnyMesh& before,
                                      const AnyMesh& after, double hausdorff_tolerance = 0);

/// Listed facets that cross each other: one line that names the first two, empty if there are none.
/// Facets that only touch, or are coplanar, up to rounding, do not cross: moving one by 2e-10 of
/// the extent plus the rounding of coordinates would separate them, as on both sides of a closed
/// crack. If the boundary does not cross itself, elements of positive volume overlap by no more
/// than that. Throws InputError unless all vertices have coordinates and facets name only existing
/// ones. Takes n log n in the facets. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_boundary(const runtime::Executor& executor, const AnyMesh& mesh);

/// Places where a mesh is not connected although its facets meet: one line for each kind, naming
/// the first vertex. Hanging vertices lie on a listed facet of which they are no corner; doubled
/// ones lie at the place of another, as along a crack. "On" means within 2e-10 of the extent plus
/// the rounding of coordinates. Empty if there are none. Throws as check_boundary() does. Takes n
/// log n in the facets. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_conformity(const runtime::Executor& executor, const AnyMesh& mesh);

/// Differences between the topologies of `after` and `before`, one line each; empty if there are
/// none. For the whole, and for the elements of each reference that both have, it compares the
/// number of connected parts, of connected parts of the boundary around them, and the boundary's
/// Euler characteristic; the last two also with the boundary cut along all edges (2D: vertices)
/// where it touches itself. Boundary that `before` does not list counts too; `after` must list its
/// own, see check_mesh(). Throws InputError unless both meshes have the same dimension and all
/// coordinates, references and vertices. Nearly linear in the meshes. Thread safety: one caller;
/// runs on the executor.
std::vector<std::string> check_topology(const runtime::Executor& executor, const AnyMesh& before,
                                        const AnyMesh& after);

/// Faults of an adapted mesh, from the first of these checks that finds any: check_mesh(),
/// check_domain(), check_topology() and, if the boundary may move, check_boundary(), unless the
/// boundary of `before` crosses itself too. Throws what they throw. Thread safety: one caller; runs
/// on the executor.
std::vector<std::string> check_adapted(const runtime::Executor& executor, const AnyMesh& before,
                                       const AnyMesh& after, double hausdorff_tolerance = 0);

/// Throws InputError, as adapt() with these options would, unless the mesh can be adapted; returns
/// the warnings of adapt(). Thread safety: one caller; runs on the executor.
std::vector<std::string> expect_adaptable(const runtime::Executor& executor, const AnyMesh& mesh,
                                          const MakeMeshOptions& options = {});

}  // namespace ductile::meshadapt
