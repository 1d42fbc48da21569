/// @file
/// Gradation: limit_gradation() for several metrics of one mesh, whose edges are found once
/// (private to mesh adaptation).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/worklist.hpp"
#include "metric/vertex_neighbours.hpp"

namespace ductile::meshadapt {

/// Sizes spread from the finest vertices on, as in Dijkstra's algorithm: in each sweep, vertices
/// that are nearly as fine as the finest one that still has to spread raise their neighbours'
/// metrics. Metrics mostly spread to coarser ones, so most vertices spread only after their metric
/// is final. A vertex that is raised later spreads again.
template <int Dim, class AMesh>
class Gradation {
 public:
  /// Thread safety of this and the following: one caller; runs on the executor.
  Gradation(const runtime::Executor& executor, const AMesh& mesh, std::size_t vertices);

  GradationReport limit(std::vector<Metric<Dim>>& metric_of, const GradationOptions& options);

 private:
  using Metrics = std::vector<Metric<Dim>>;  // [vertex]

  enum class State : std::uint8_t {
    settled,   ///< its metric has spread
    waiting,   ///< its metric has not spread yet
    source,    ///< spreads in this sweep
    spreading  ///< a source that reaches a neighbour; its axes are known
  };

  struct Raised {
    VertexId vertex;
    Metric<Dim> metric;
    double finest;
  };

  void take_sources();
  std::size_t spread(Metrics& metric_of);
  void find_reached(const Metrics& metric_of);
  bool raise_from_sources(const Metrics& metric_of, Raised& at);
  double growth_beyond(const Metrics& metric_of, VertexId from, VertexId to,
                       const Metric<Dim>& there) const;
  Raised grown(VertexId from, VertexId to, double growth) const;

  const runtime::Executor& executor_;
  const AMesh& mesh_;
  double rate_ = 0;       // growth per unit length
  double tolerance_ = 0;  // see GradationOptions
  runtime::UnsetVector<VertexId> waiting_, sources_;
  runtime::UnsetVector<State> state_of_;              // [vertex]
  runtime::UnsetVector<double> fineness_of_;          // [vertex], trace of the metric
  runtime::UnsetVector<PrincipalAxes<Dim>> axes_of_;  // [vertex], where it is spreading
  runtime::UnsetVector<double> finest_of_;  // [vertex], no eigenvalue is larger; 0: not known yet
  VertexNeighbours<AMesh> neighbours_;
  runtime::Worklist<VertexId> reached_;
};

}  // namespace ductile::meshadapt
