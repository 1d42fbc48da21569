/// @file
/// bound_curved_sizes: how large elements on curved boundaries can be that have to stay close.
#pragma once

#include <vector>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Makes metrics finer, in all directions alike, at vertices of smooth patches, so that edges there
/// are no longer than chords that stay within the tolerance of them: one of length h is k h^2 / 8
/// from an arc of curvature k. Not so fine that the edges that the mesh has there would be too
/// long. Curvature is that of the turns from facet to facet around the vertex (Cohen-Steiner &
/// Morvan, "Restricted Delaunay triangulations and normal cycle", SoCG 2003). Linear in the mesh.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of);

extern template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                        std::vector<Metric<2>>&);
extern template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                        std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
