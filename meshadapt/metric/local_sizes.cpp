#include "ductile/meshadapt/sizes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/entities_of.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// The finer of two bounds, of which 0 is none.
double finer(double a, double b) { return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b); }

/// The bounds at each vertex. Entities of lower dimensions come later and replace the bounds of
/// higher ones.
std::vector<SizeBounds> bounds_of(const AnyMesh& mesh, const std::vector<LocalSize>& local_sizes,
                                  const SizeBounds& elsewhere) {
  std::vector<SizeBounds> bounds(mesh.vertex_count(), elsewhere);
  std::vector<int> dimension_of(mesh.vertex_count(), mesh.dimension + 1);  // of what has said it
  for (int dimension = mesh.dimension; dimension >= 0; --dimension)
    for (const LocalSize& local : local_sizes) {
      if (local.dimension != dimension) continue;
      const double smallest = local.smallest > 0 ? local.smallest : elsewhere.smallest;
      const double largest = local.largest > 0 ? local.largest : elsewhere.largest;
      for (const auto& corners : entities_of(mesh, dimension, local.reference).corners)
        for (std::size_t c = 0; c <= static_cast<std::size_t>(dimension); ++c) {
          SizeBounds& here = bounds[corners[c]];
          const bool first = std::exchange(dimension_of[corners[c]], dimension) != dimension;
          here.smallest = first ? smallest : std::min(here.smallest, smallest);
          here.largest = first ? largest : finer(here.largest, largest);
        }
    }
  for (SizeBounds& here : bounds)  // a bound of its own wins over one of elsewhere
    if (here.largest > 0) here.smallest = std::min(here.smallest, here.largest);
  return bounds;
}

template <int Dim>
AnyField bound(const Executor& executor, const AnyField& metric,
               const std::vector<SizeBounds>& bounds) {
  std::vector<Metric<Dim>> metric_of = tensors_of<Dim>(executor, metric);
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    if (has_bounds(bounds[v])) metric_of[v] = with_bounded_sizes(metric_of[v], bounds[v]);
  });
  return symmetric_field(executor, metric_of, metric.name);
}

}  // namespace

AnyField bound_sizes_locally(const Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                             const std::vector<LocalSize>& local_sizes,
                             const SizeBounds& elsewhere) {
  expect_coordinates(mesh);
  expect_references(mesh);
  expect_field_of(metric, mesh);
  expect_bounds(elsewhere);
  for (std::size_t i = 0; i < local_sizes.size(); ++i) {
    const LocalSize& local = local_sizes[i];
    const std::string name = "local_sizes[" + std::to_string(i) + "]: ";
    if (local.dimension < 0 || local.dimension > mesh.dimension)
      throw InputError(name + "expected entities of a dimension from 0 to " +
                       std::to_string(mesh.dimension) + ", found " +
                       std::to_string(local.dimension));
    try {
      expect_bounds({.smallest = local.smallest, .largest = local.largest});
    } catch (const InputError& error) {
      throw InputError(name + error.what());
    }
  }
  const std::vector<SizeBounds> bounds = bounds_of(mesh, local_sizes, elsewhere);
  return mesh.dimension == 2 ? bound<2>(executor, metric, bounds)
                             : bound<3>(executor, metric, bounds);
}

}  // namespace ductile::meshadapt
