/// @file
/// check_mesh: says what is wrong with a mesh, if anything: of one that is to be written whether it
/// is a mesh at all, of one that is being adapted whether its parts still agree with each other.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// What is wrong, a line for each kind of fault, naming the first entity that has it (numbered from
/// 1, as in a file) and how many have; empty if nothing is. Checked: indices in range, every vertex
/// used, every element with a positive volume (exactly), no facet with more than two elements or
/// with two on one side, every boundary facet listed once and nothing listed that is not there.
/// Linear in the mesh. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_mesh(const runtime::Executor& executor, const AnyMesh& mesh);

/// How the domain of `after` differs from that of `before`, a line each; empty if it does not: the
/// measure (area or volume) of the whole, of the elements of each reference, and of the listed
/// boundary facets and interfaces by reference (length or area). They agree to 1e-9 of the total
/// and to what the boundary can go astray, in thin domains and far from the origin the greater of
/// the two: 2e-10 of the extent and the rounding of coordinates. What adaptation must never change.
/// With a surface tolerance (see MakeMeshOptions) the whole, and each region, may differ by as much
/// as boundaries that far away make it, and boundaries only have to be there still. Nor may the
/// boundary of `after` meet itself, at vertices in 2D or along edges in 3D, where that of `before`
/// did not. Boundary that `before` does not list counts as of reference 0, if it lists some. Throws
/// InputError unless both meshes are of one dimension, have all coordinates and references, and
/// name no vertices beyond those that there are.
/// Linear in the meshes but for a logarithm in the facets. Thread safety: one caller; runs on the
/// executor.
std::vector<std::string> check_domain(const runtime::Executor& executor, const AnyMesh& before,
                                      const AnyMesh& after, double hausdorff_tolerance = 0);

/// Which listed facets cross each other: a line that names the first two, empty if none do. Those
/// that only touch, or lie in one plane, or do so but for rounding, do not cross: so it is if one
/// need only move by 2e-10 of the extent, and the rounding of coordinates, for them to be apart, as
/// it may be on both sides of a closed crack. Elements of positive volume whose boundary does not
/// cross itself do not overlap by more. Throws InputError unless all vertices have coordinates and
/// facets name no others.
/// Takes a logarithm more than linear in the facets. Thread safety: one caller; runs on the
/// executor.
std::vector<std::string> check_boundary(const runtime::Executor& executor, const AnyMesh& mesh);

/// Where a mesh is not connected although its facets meet, a line for each kind, naming the first
/// vertex: those that lie on a listed facet of which they are no corner (they hang), and those at
/// the place of another (they are doubled, as along a crack). "On" means within 2e-10 of the extent
/// and the rounding of coordinates. Empty if there are none. Throws as check_boundary() does.
/// Takes a logarithm more than linear in the facets. Thread safety: one caller; runs on the
/// executor.
std::vector<std::string> check_conformity(const runtime::Executor& executor, const AnyMesh& mesh);

/// How the topology of `after` differs from that of `before`, a line each; empty if it does not. Of
/// the whole and of the elements of each reference that both have are compared: the number of
/// connected parts, that of connected parts of the boundary around them, and its Euler
/// characteristic; the last two also where the boundary is cut up along all edges, in 2D at all
/// vertices, at which it meets itself. Boundary that `before` does not list counts as well; that of
/// `after` is listed, as check_mesh() says. Throws InputError unless both meshes are of one
/// dimension and have all coordinates, references and vertices.
/// Nearly linear in the meshes. Thread safety: one caller; runs on the executor.
std::vector<std::string> check_topology(const runtime::Executor& executor, const AnyMesh& before,
                                        const AnyMesh& after);

/// What is wrong with an adapted mesh, by the first of these checks that finds something:
/// check_mesh(), check_domain(), check_topology() and, if the boundary may move, check_boundary(),
/// unless the boundary of `before` crosses itself, too. Throws what they throw.
/// Thread safety: one caller; runs on the executor.
std::vector<std::string> check_adapted(const runtime::Executor& executor, const AnyMesh& before,
                                       const AnyMesh& after, double hausdorff_tolerance = 0);

/// Throws InputError, as adapt() with these options does, unless the mesh can be adapted; returns
/// what adapt() would warn of. Thread safety: one caller; runs on the executor.
std::vector<std::string> expect_adaptable(const runtime::Executor& executor, const AnyMesh& mesh,
                                          const MakeMeshOptions& options = {});

}  // namespace ductile::meshadapt
