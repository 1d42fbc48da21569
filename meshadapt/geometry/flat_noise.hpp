/// @file
/// noise_in_flat_faces: by how much the faces of a mesh are off flat where that looks like noise in
/// coordinates, as rounding leaves that no longer shows in their digits, and like no curve.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// A length; 0 if most faces are flat, or bend, or are too small to tell. Judges the facets that
/// the mesh lists. Thread safety: one caller; runs on the executor.
template <int Dim>
double noise_in_flat_faces(const runtime::Executor& executor, const AnyMesh& mesh);

extern template double noise_in_flat_faces<2>(const runtime::Executor&, const AnyMesh&);
extern template double noise_in_flat_faces<3>(const runtime::Executor&, const AnyMesh&);

}  // namespace ductile::meshadapt
