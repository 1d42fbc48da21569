/// @file
/// round_boundary: writes what is new or moved on the boundary as precisely as the input was, where
/// that is flat only up to its precision, so that it is as flat when it is read again.
#pragma once

#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Moves vertices of the boundary and of interfaces to the closest place that is written as
/// precisely as the input, on their plane or line but for that, if mesh.rounding is set. One stays
/// where it is if elements would get much poorer, or its smooth patch would be left. Thread safety:
/// one caller; runs on it alone.
template <int Dim, int Space>
void round_boundary(Mesh<Dim, Space>& mesh);

extern template void round_boundary(Mesh<2>&);
extern template void round_boundary(Mesh<2, 3>&);
extern template void round_boundary(Mesh<3>&);

}  // namespace ductile::meshadapt
