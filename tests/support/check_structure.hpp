/// @file
/// The check of a mesh that is being adapted: each invariant of its data structure by brute force.
#pragma once

#include <string>
#include <vector>

#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// As check_mesh() of an AnyMesh, for a mesh that is being adapted; entities are numbered from 0.
/// Also checks that the lists of vertices agree with the corners of elements, cached qualities are
/// up to date, facets carry the same patch on both sides, patches are flat, curves are straight,
/// and the freedom of vertices fits the entities that they lie on. Slower; for tests and debugging.
template <int Dim>
std::vector<std::string> check_mesh(const runtime::Executor& executor, const Mesh<Dim>& mesh);

extern template std::vector<std::string> check_mesh(const runtime::Executor&, const Mesh<2>&);
extern template std::vector<std::string> check_mesh(const runtime::Executor&, const Mesh<3>&);

}  // namespace ductile::meshadapt
