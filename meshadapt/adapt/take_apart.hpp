/// @file
/// take_apart(): from an adapted Mesh<Dim> to a mesh as it stands in a file. Entities to be listed
/// are found on all threads and gathered in the order of vertices or elements, so that the lists do
/// not depend on the number of threads.
#pragma once

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The mesh as a file holds it: boundary and interface facets, curves, corners and required
/// entities with their references. Deleted entities are left out, and the others numbered as
/// renumber() would number them. Arrays are given back as soon as they have been read, which takes
/// less memory. Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
MeshWithMetric take_apart(const runtime::Executor& executor, Mesh<Dim, Space> mesh);

/// Renumbers the mesh; returns the same for a mesh that is still needed, with the same numbers.
template <int Dim, int Space>
MeshWithMetric copy_in_order(const runtime::Executor& executor, Mesh<Dim, Space>& mesh);

}  // namespace ductile::meshadapt
