/// @file
/// limit_gradation() of the metrics of a mesh that is being adapted.
#pragma once

#include <vector>

#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// As on a FixedMesh; whether they are metrics is not checked.
template <int Dim, int Space>
GradationReport limit_gradation(const runtime::Executor& executor,
                                std::vector<Metric<Space>>& metric_of, const Mesh<Dim, Space>& mesh,
                                const GradationOptions& options = {});

}  // namespace ductile::meshadapt
