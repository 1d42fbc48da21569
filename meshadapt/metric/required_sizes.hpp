/// @file
/// take_required_sizes: what may not change keeps the sizes that it has, whatever a metric asks for
/// there, so the metric is made to fit it, and to go over into what was asked for no faster than a
/// mesh can. Without it, elements between a frozen interface and a metric of other sizes have no
/// good shape.
#pragma once

#include <vector>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// At the vertices of required facets, edges and elements, metric_of becomes the mean, of
/// logarithms, of metrics in which their edges have length 1. Where the edges are no more stretched
/// there than by a factor of 2 beside what the metric asks for, that is the metric times a factor.
/// Across a facet, or an edge, sizes change by the same factor as along it, but not beyond its own
/// edges. Edges between two required vertices that nothing else says anything of count if they are
/// too short, because they cannot be removed.
///
/// From these vertices sizes change by at most `factor` per unit of metric length, up to where the
/// metric asks for what is allowed: those that it asks for elsewhere are made finer as
/// limit_gradation does it, and coarser along each edge pq so that a size h of M_p is at least
/// h (1 - l ln(factor)) at q, where l is the length of pq in M_p. Where both hold, the finer sizes
/// are taken. No other metric changes.
///
/// Does not depend on the number of threads. Throws InputError if the factor is below 1 or not
/// finite; std::bad_alloc if memory runs out. Thread safety: one caller; runs on the executor.
template <int Dim>
GradationReport take_required_sizes(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                                    double factor, std::vector<Metric<Dim>>& metric_of);

extern template GradationReport take_required_sizes(const runtime::Executor&, const Mesh<2>&,
                                                    double, std::vector<Metric<2>>&);
extern template GradationReport take_required_sizes(const runtime::Executor&, const Mesh<3>&,
                                                    double, std::vector<Metric<3>>&);

}  // namespace ductile::meshadapt
