/// @file
/// From a mesh as it stands in a file to a Mesh<Dim> that can be adapted. Making one
/// checks that the file's mesh is one: every index in range, every element with a volume, all
/// turned the same way, every facet shared by at most two elements, the boundary listed.
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/adapt_options.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Classifies vertices and finds patches and curves; metrics are left unset, hosts are the element
/// numbers themselves. Vertices and elements keep their numbers. `neighbours` receives the element
/// neighbours. Warnings (reoriented, unused vertices and edges) are appended. Throws InputError
/// naming the entity, numbered from 1 as in the file, or an option that is out of range. Thread
/// safety: one caller; runs on the executor.
template <int Dim>
Mesh<Dim> make_mesh(const runtime::Executor& executor, const AnyMesh& any,
                    const MakeMeshOptions& options, Neighbours<Dim>& neighbours,
                    std::vector<std::string>& warnings);

/// The same of a mesh that was cut from a larger one: boundary facets that it does not list are
/// where it was cut, and no boundary, unless options.complete_boundary is set.
template <int Dim>
Mesh<Dim> make_cut_mesh(const runtime::Executor& executor, const AnyMesh& any,
                        const MakeMeshOptions& options, Neighbours<Dim>& neighbours,
                        std::vector<std::string>& warnings);

}  // namespace ductile::meshadapt
