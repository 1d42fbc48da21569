/// @file
/// take_required_sizes: what may not change keeps the sizes that it has, whatever a metric asks for
/// there, so the metric is made to fit it, and to go over into what was asked for no faster than a
/// mesh can. Without it, elements between a frozen interface and a metric of other sizes have no
/// good shape.
#pragma once

#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/executor.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

/// At the vertices of required facets, edges and elements, metric_of becomes the mean, of
/// logarithms, of metrics in which their edges have length 1. Where the edges are no more stretched
/// there than by a factor of 2 beside what the metric asks for, that is the metric times a factor;
/// no metric is stretched by more than 16 beside it, and none has sizes below 1/50 of the longest
/// edge there. Across a facet, or an edge, sizes change by the same factor as along it, but not
/// beyond its own edges. Edges between two required vertices that nothing else says anything of
/// count if they are too short, because they cannot be removed.
///
/// From these vertices sizes change by at most `factor` per unit of metric length, up to where the
/// metric asks for what is allowed. Along each edge pq, of length l in M_p, a size h along an axis
/// of M_p may be at most h sqrt(g g_h) at q, where g = 1 + l ln(factor) and g_h = 1 + |pq|/h
/// ln(factor), and must be at least h (1 - l ln(factor)). For isotropic metrics that is h + |pq|
/// ln(factor) and h - |pq| ln(factor). Where both say something, the finer sizes are taken. No
/// other metric changes.
///
/// Does not depend on the number of threads. Expects a factor of 1 or more. Throws
/// std::bad_alloc if memory runs out. Thread safety: one caller; runs on the executor.
template <int Dim, int Space>
GradationReport take_required_sizes(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                                    double factor, std::vector<Metric<Space>>& metric_of);

}  // namespace ductile::meshadapt
