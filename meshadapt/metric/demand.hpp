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
template <int Dim, int Space>
double complexity_of_demand(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                            const std::vector<Metric<Space>>& metric_of);

/// How much of what the metrics of a mesh ask for lies in elements that are much too coarse for how
/// sizes change (see is_steep). All elements must be there. Thread safety: as above.
template <int Dim, int Space>
double share_of_steep(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh);

/// A lower bound on the elements of a mesh with unit edges, which the integral above misses where
/// the mesh is thin: elements cover the longest edge, and have the boundary's facets. 0 if
/// something is required, which may stay as coarse as it is. Thread safety: as above.
template <int Dim, int Space>
double least_elements(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                      const std::vector<Metric<Space>>& metric_of);

/// Throws InputError if there would certainly be more elements than 32 bits count.
void expect_countable(const std::string& name, int dimension, double elements);

/// Throws Error if so many elements would certainly take more bytes than `limit`, by a margin: it
/// is 0.8 of their number, and 0.85 of their memory, that are too many.
void expect_room(const std::string& name, int dimension, double elements, std::size_t limit);

}  // namespace ductile::meshadapt
