/// @file
/// Background<Dim>: the input mesh with its metric, kept while the mesh is adapted. Whatever vertex
/// the adaptation makes or moves gets its metric from here, so repeated passes do not blur it.
/// Points are located by walking from an element nearby; what a walk does not find, by a tree.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/atomic.hpp"
#include "mesh/mesh.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space>
class BoxTree;
template <int Dim>
struct ClosestPoint;

/// The input mesh with its metric; see the top of this file.
template <int Dim, int Space = Dim>
class Background {
 public:
  /// Copies elements, positions and metrics of the mesh; takes over its neighbours.
  Background(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
             Neighbours<Dim> neighbours);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// The element that holds a point, and the metric there: log-Euclidean interpolation (Arsigny,
  /// Fillard, Pennec & Ayache, SIAM J. Matrix Anal. Appl. 29, 2007) of the element's vertices; in
  /// an element much too coarse for how they differ, with sizes that grow linearly.
  struct Sample {
    ElementId host;
    Metric<Space> metric;
  };

  /// The metric at a point, found by walking from the element `near`. Of a point outside, the
  /// metric is that of the closest point of the mesh, and so is the host, or, if the mesh has
  /// curved boundaries, those of an element that is close to it. If `near` is no element, the walk
  /// starts at the first. Of a point that is no number the host is an element, but its metric is no
  /// number either. Thread safety: any thread.
  Sample sample(const Vector<Space>& point, ElementId near) const;

  /// Starts to bring where a walk begins into the cache. Thread safety: any thread.
  [[gnu::always_inline]] void prefetch(ElementId near) const {
    __builtin_prefetch(&corners_of_[near]);
    __builtin_prefetch(&neighbours_[near]);
  }

  /// The same for the corners of that element, which must be one of the background's. Reads its
  /// numbers: waits unless prefetch() has brought them. Thread safety: any thread.
  [[gnu::always_inline]] void prefetch_corners(ElementId near) const {
    for (const VertexId v : corners_of_[near]) {
      __builtin_prefetch(&position_of_[v]);
      __builtin_prefetch(&log_metric_of_[v]);
    }
  }

  /// The logarithm of the metric at one of its vertices. Thread safety: to change it, while nobody
  /// samples, one thread for each vertex.
  Metric<Space>& log_metric(VertexId v) { return log_metric_of_[v]; }

  /// The integral over the mesh of sqrt(det metric). Thread safety: while nobody changes metrics.
  double complexity(const runtime::Executor& executor) const;

  /// Gives the memory of its elements and vertices back, by all threads of an executor; there is
  /// nothing to sample any more. Thread safety: one thread.
  void release(const runtime::Executor& executor);

  std::size_t element_count() const { return corners_of_.size(); }
  /// Memory in use. Thread safety: any thread.
  std::size_t bytes() const;

 private:
  bool is_far_off(ElementId element, const Vector<Space>& point) const;
  ClosestPoint<Dim> closest(const Vector<Space>& point) const;
  std::array<Vector<Space>, Dim + 1> places_of(ElementId element) const;

  GrowingArray<Corners<Dim>> corners_of_;      // [element]
  Neighbours<Dim> neighbours_;                 // [element][facet]
  GrowingArray<Vector<Space>> position_of_;    // [vertex]
  GrowingArray<Metric<Space>> log_metric_of_;  // [vertex]
  // Seldom needed: few walks end at a hole or outside.
  mutable runtime::Lazy<std::unique_ptr<BoxTree<Dim, Space>>> tree_;
  double slack_;  // by how much weights may be negative where a walk ends outside
};

extern template class Background<2>;
extern template class Background<2, 3>;
extern template class Background<3>;

}  // namespace ductile::meshadapt
