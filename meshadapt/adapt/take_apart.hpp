/// @file
/// take_apart(): from a Mesh<Dim> that was adapted to a mesh as it stands in a file. What is to be
/// listed is found on all threads and gathered in the order of vertices or elements, so that the
/// lists do not depend on their number.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

struct MeshWithMetric {
  AnyMesh mesh;
  AnyField metric;  ///< at the vertices
};

/// The mesh as a file holds it: boundary and interface facets, curves, corners and required
/// entities with their references. What is gone is left out, and the rest numbered as renumber()
/// would number it. The mesh's arrays are given back as soon as they have been read, so that there
/// is less to hold at once. Thread safety: one caller; runs on the executor.
template <int Dim>
MeshWithMetric take_apart(const runtime::Executor& executor, Mesh<Dim> mesh);

}  // namespace ductile::meshadapt
