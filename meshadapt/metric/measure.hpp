/// @file
/// measure() of statistics.hpp for a mesh whose adjacency is kept for others as well.
#pragma once

#include "ductile/meshadapt/statistics.hpp"
#include "mesh/adjacency.hpp"

namespace ductile::meshadapt {

/// Thread safety: one caller; runs on the executor of the mesh.
MeshStatistics measure(const AdjacentMesh& mesh, const AnyField* metric);

}  // namespace ductile::meshadapt
