/// @file
/// Operations on a metric before a mesh is adapted to it: bounds on sizes, the intersection of two
/// metrics, and a limit on how fast sizes grow from vertex to vertex. None of them makes a metric
/// ask for coarser sizes, except a smallest size.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// The finest sizes that either metric asks for: the largest ellipsoid inside both unit balls, by
/// simultaneous reduction (Alauzet & Frey, INRIA RR-4759, 2003). No length is shorter in the result
/// than in `a` or `b`, up to the rounding of their components; if one is at least as fine as the
/// other in every direction, it is returned unchanged; the order does not matter, bit for bit. Both
/// are positive definite. Thread safety: any thread.
template <int Dim>
Metric<Dim> intersect(const Metric<Dim>& a, const Metric<Dim>& b);

/// Intersects metric_of[vertex] with other_of[vertex] at every vertex. Throws InputError unless
/// there are as many, all of them metrics (see metric_of). Thread safety: one caller; runs on the
/// executor.
template <int Dim>
void intersect(const runtime::Executor& executor, std::vector<Metric<Dim>>& metric_of,
               const std::vector<Metric<Dim>>& other_of);

/// Bounds on edge lengths that a metric may ask for; 0 is no bound.
struct SizeBounds {
  double smallest = 0;
  double largest = 0;
  double anisotropy = 0;  ///< the longest size at a vertex over the shortest, at least 1
};

/// Clamps the sizes 1/sqrt(eigenvalue) of every metric to the bounds, then shortens those that
/// exceed the anisotropy; a metric within the bounds keeps its bits. An eigenvalue that is 0 up to
/// rounding gets the largest size. Throws InputError if a bound on sizes is neither 0 nor from
/// 1e-75 to 1e75, the smallest is above the largest, the anisotropy is below 1 or not finite, or an
/// input is not a metric within the bounds (see metric_of). Thread safety: one caller; runs on the
/// executor.
template <int Dim>
void bound_sizes(const runtime::Executor& executor, std::vector<Metric<Dim>>& metric_of,
                 const SizeBounds& bounds);

/// How fast sizes may grow, see limit_gradation().
struct GradationOptions {
  double factor = 1.3;  ///< growth of sizes per unit of metric length, at least 1; Mmg's default
  double tolerance = 1e-3;  ///< relative excess of a squared length that is tolerated
  int sweeps = 1000;        ///< at most this many
};

/// Statistics of limit_gradation().
struct GradationReport {
  int sweeps = 0;
  std::size_t raised = 0;  ///< how often a vertex got a finer metric
  bool converged = false;  ///< false: the limit on sweeps was reached first
};

/// Refines metrics until, along each edge pq, sizes grow by at most about `factor` per unit of
/// metric length. Each size h of M_p, along one of its axes, may become h g^(7/8) g_h^(1/8) in M_q,
/// where g = 1 + l ln(factor) with the length l of pq in M_p, and
/// g_h = 1 + |pq| / h ln(factor). M_q then measures no length less than that metric does. This is
/// the mixed law of Alauzet, "Size gradation control of anisotropic meshes", Finite Elem. Anal.
/// Des. 46 (2010): with g alone, metrics spread with all of their anisotropy, so that differing
/// directions cause short edges in many directions over long distances. Isotropic metrics grow by
/// g, because g_h is the same. No size ends more than a tenth below the smallest of those that
/// spread to it. In each sweep a vertex intersects its metric with its neighbours' from before the
/// sweep, in the order of their numbers, so the result does not depend on threads or timing.
/// metric_of is indexed by the vertices of the mesh, whose own metrics are not read. Throws
/// InputError if the factor is below 1 or not finite, the tolerance or the sweeps are negative, or
/// there is not a metric (see metric_of) for each vertex; std::bad_alloc if memory runs out. Thread
/// safety: one caller; runs on the executor.
template <int Dim, int Space>
GradationReport limit_gradation(const runtime::Executor& executor,
                                std::vector<Metric<Space>>& metric_of,
                                const FixedMesh<Dim, Space>& mesh,
                                const GradationOptions& options = {});

extern template Metric<2> intersect(const Metric<2>&, const Metric<2>&);
extern template Metric<3> intersect(const Metric<3>&, const Metric<3>&);
extern template void intersect(const runtime::Executor&, std::vector<Metric<2>>&,
                               const std::vector<Metric<2>>&);
extern template void intersect(const runtime::Executor&, std::vector<Metric<3>>&,
                               const std::vector<Metric<3>>&);
extern template void bound_sizes(const runtime::Executor&, std::vector<Metric<2>>&,
                                 const SizeBounds&);
extern template void bound_sizes(const runtime::Executor&, std::vector<Metric<3>>&,
                                 const SizeBounds&);
extern template GradationReport limit_gradation(const runtime::Executor&, std::vector<Metric<2>>&,
                                                const FixedMesh<2>&, const GradationOptions&);
extern template GradationReport limit_gradation(const runtime::Executor&, std::vector<Metric<3>>&,
                                                const FixedMesh<2, 3>&, const GradationOptions&);
extern template GradationReport limit_gradation(const runtime::Executor&, std::vector<Metric<3>>&,
                                                const FixedMesh<3>&, const GradationOptions&);

}  // namespace ductile::meshadapt
