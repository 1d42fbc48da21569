/// @file
/// Statistics of a mesh: lengths of its edges and quality of its elements, in a metric or
/// Euclidean. Lengths are those of the unstructured grid adaptation working group (Ibanez et al.,
/// Procedia Eng. 203, 2017), quality is its mean ratio in the mean metric of an element
/// (mean_metric() in quality.hpp). The figures do not depend on threads or timing.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::meshadapt {

/// Summary of a set of numbers. All zero for an empty set.
struct Distribution {
  std::size_t count = 0;
  double min = 0;
  double low = 0;  ///< 1 % are at most this (nearest rank)
  double median = 0;
  double mean = 0;
  double max = 0;
  double histogram_from = 0, histogram_to = 1;  ///< range of the bins, which are of equal width
  std::array<std::size_t, 10> histogram{};
  std::size_t below = 0, above = 0;  ///< outside the histogram
};

/// Lengths of edges and quality of elements of a mesh, see measure().
struct MeshStatistics {
  bool in_metric = false;  ///< false: Euclidean lengths
  Distribution edge_length;
  Distribution quality;            ///< mean ratio: 1 ideal, 0 flat, negative inverted
  std::size_t edges_in_range = 0;  ///< metric length in [1/sqrt 2, sqrt 2]; 0 without a metric
  std::size_t edges_short = 0, edges_long = 0;
  double complexity = 0;  ///< integral of sqrt(det metric), 0 without a metric

  double share_in_range() const {
    return edge_length.count == 0
               ? 0
               : static_cast<double>(edges_in_range) / static_cast<double>(edge_length.count);
  }
};

/// Measures the triangles of a mesh of dimension 2, the tetrahedra of one of dimension 3. `metric`
/// is one symmetric tensor per vertex (see metric_of), or null for Euclidean figures. Throws
/// InputError unless vertices have coordinates and references, the metric has a tensor for each,
/// and elements name only existing vertices. Thread safety: one thread; runs on the executor.
MeshStatistics measure(const runtime::Executor& executor, const AnyMesh& mesh,
                       const AnyField* metric);

/// Quality of each element, [element]: the mean ratio in the metric of its corner of largest
/// determinant; where several corners have that determinant, their mean. Throws as above.
/// Thread safety: one thread; runs on the executor.
std::vector<double> element_qualities(const runtime::Executor& executor, const AnyMesh& mesh,
                                      const AnyField* metric);

/// Summary of `values`, with a histogram over [from, to]. If some are NaN, only the count is
/// reliable. Thread safety: one caller; runs on the executor.
Distribution distribution(const runtime::Executor& executor, std::span<const double> values,
                          double from, double to);

}  // namespace ductile::meshadapt
