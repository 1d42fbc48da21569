/// @file
/// roughness: how far flat boundaries and interfaces of a mesh may be from flat, because of how
/// precisely they were written.
#pragma once

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

/// A length; 0 where all that is flat is so by all digits, and for what is not a valid mesh. As
/// adapt() sees it, whose result may differ from the mesh by as much. Thread safety: any thread.
template <int Dim>
double roughness(const AnyMesh& mesh);

extern template double roughness<2>(const AnyMesh&);
extern template double roughness<3>(const AnyMesh&);

}  // namespace ductile::meshadapt
