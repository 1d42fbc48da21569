/// @file
/// bound_curved_sizes: how large elements on curved boundaries can be that have to stay close.
#pragma once

#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// Makes metrics finer at vertices of smooth patches and curves, in the directions in which these
/// bend, so that edges there are no longer than chords that stay within the tolerance of them: one
/// of length h is k h^2 / 8 from an arc of curvature k. A patch has two such directions; across it
/// sizes are those of the one that bends more. Curvature is that of the model's normals, or of the
/// curve's edges, over all that is no farther away than 1.25 such chords, or than the sizes asked
/// for, and at least seven vertices, so that it does not depend on how the facets are cut, and what
/// a single facet does cancels. Up to 1.5 times as far a fit that bends less takes its place if all
/// vertices there are within half of the tolerance of it: what bends more is noise.
/// Sizes are not smaller than the edges that the mesh has there, each in its direction, or the flat
/// parts that the patch is made of, where these are larger than the chords: to divide them would
/// bring nothing closer. They are never smaller than twice the tolerance. The mesh has a surface.
/// Linear in the mesh, times a logarithm. Thread safety: one caller; runs on the executor.
template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of);

extern template void bound_curved_sizes(const runtime::Executor&, const Mesh<2>&, double,
                                        std::vector<Metric<2>>&);
extern template void bound_curved_sizes(const runtime::Executor&, const Mesh<3>&, double,
                                        std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
