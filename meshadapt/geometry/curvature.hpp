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
/// sizes are those of the one that bends more. Curvature is that of the model's normals and
/// tangents (see CurvatureFit) over all that is no farther away than 1.25 such chords, or than the
/// sizes asked for, and at least seven samples (three on curves), so that it does not depend on how
/// the model's facets are cut, and what a single facet does cancels. Up to 1.5 times as far a fit
/// that bends less takes its place if all samples there are within half of the tolerance of it:
/// what bends more is noise. Sizes are not smaller than the edges that the model's facets have
/// there, each in its direction, or than flat parts of several facets: to divide these would bring
/// nothing closer. They are never smaller than twice the tolerance. The mesh has a surface. Linear
/// in the mesh and the model, times a logarithm. Thread safety: one caller; runs on the executor.
template <int Dim>
void bound_curved_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh, double tolerance,
                        std::vector<Metric<Dim>>& metric_of);

}  // namespace ductile::meshadapt
