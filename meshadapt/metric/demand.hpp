/// @file
/// demand: how many elements a metric asks for on a mesh, and what they take (private to mesh
/// adaptation).
#pragma once

#include <string>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// The integral over the mesh of sqrt(det metric) as it is interpolated, see interpolation.hpp.
/// Thread safety: one caller; runs on the executor.
template <int Dim>
double complexity_of_demand(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                            const std::vector<Metric<Dim>>& metric_of);

/// How much of what the metrics of a mesh ask for lies in elements that are much too coarse for how
/// sizes change (see is_steep). All elements must be there. Thread safety: as above.
template <int Dim>
double share_of_steep(const runtime::Executor& executor, const Mesh<Dim>& mesh);

/// Throws InputError if there would be more elements than 32 bits count.
void expect_countable(const std::string& name, double complexity);

/// Throws Error if elements for so much complexity would certainly take more bytes than `limit`, by
/// a margin: it is 0.8 of their number, and 0.85 of their memory, that are too many.
void expect_room(const std::string& name, int dimension, double complexity, std::size_t limit);

extern template double complexity_of_demand(const runtime::Executor&, const Mesh<2>&,
                                            const std::vector<Metric<2>>&);
extern template double complexity_of_demand(const runtime::Executor&, const Mesh<3>&,
                                            const std::vector<Metric<3>>&);
extern template double share_of_steep(const runtime::Executor&, const Mesh<2>&);
extern template double share_of_steep(const runtime::Executor&, const Mesh<3>&);

}  // namespace ductile::meshadapt
