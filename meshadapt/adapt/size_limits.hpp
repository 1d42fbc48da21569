/// @file
/// Prepares a metric for an adaptation: validates tensors, keeps sizes within bounds, limits their
/// growth, and refuses too many elements. Thread safety of all: one caller; they
/// run on the executor.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/process.hpp"
#include "geometry/curvature.hpp"
#include "geometry/surface_mesh.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/mesh.hpp"
#include "mesh/wording.hpp"
#include "metric/demand.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/mesh_gradation.hpp"
#include "metric/required_sizes.hpp"

namespace ductile::meshadapt {

/// The tensors [vertex] of a metric for this mesh. Those out of range are bounded, which may make a
/// metric of them. Throws InputError for a field that is not a metric of the mesh.
template <int Space>
std::vector<Metric<Space>> valid_metrics(const runtime::Executor& executor, const AnyMesh& mesh,
                                         const AnyField& field, const SizeBounds& bounds) {
  if (field.types != std::vector{AnyField::Type::symmetric} || field.dimension != Space ||
      field.vertex_count != mesh.vertex_count())
    throw InputError(name_of(field) + ": expected one symmetric tensor for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices of " + name_of(mesh));
  expect_values(field);
  expect_metric_field<Space>(executor, field, bounds);
  auto metric_of = runtime::make_vector<Metric<Space>>(executor, field.vertex_count);
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    Metric<Space>& metric = metric_of[v];
    std::copy_n(&field.values[v * metric.m.size()], metric.m.size(), metric.m.begin());
    if (has_bounds(bounds) && !in_range(metric)) metric = within_bounds(metric, bounds);
  });
  return metric_of;
}

/// The growth factor asked for; 0: none.
inline double growth_of(const AdaptOptions& options) {
  constexpr double from_curves = 1.3;
  return options.curved_sizes && options.gradation == 0 ? from_curves
                                                        : std::max(options.gradation, 0.0);
}

/// Do the options limit how fast sizes grow?
inline bool limits_growth(const AdaptOptions& options) {
  return options.gradation > 0 || options.curved_sizes;
}

/// Makes the metrics keep the growth that the options allow, within the bounds. Returns sentences
/// about what it could not do.
template <int Dim, int Space>
std::vector<std::string> limit_growth(const runtime::Executor& executor,
                                      const Mesh<Dim, Space>& mesh, const AdaptOptions& options,
                                      std::vector<Metric<Space>>& metric_of) {
  std::vector<std::string> warnings;
  if (const double factor = growth_of(options); factor > 0) {
    const auto report = limit_gradation(executor, metric_of, mesh, {.factor = factor});
    if (!report.converged)
      warnings.push_back("sizes still grow faster than asked for in places, after " +
                         std::to_string(report.sweeps) + " sweeps over the edges");
  }
  if (limits_growth(options))  // intersections may be finer than the metrics
    bound_sizes(executor, metric_of, {options.smallest_size, options.largest_size});
  if (options.required_gradation > 0 &&
      !take_required_sizes(executor, mesh, options.required_gradation, metric_of).converged)
    warnings.emplace_back("sizes still differ more than asked for from required ones");
  return warnings;
}

/// Makes metrics finer at vertices of facets whose SurfaceFunction has sizes.
template <int Dim>
void bound_sizes_by_functions(const runtime::Executor& executor, const Mesh<Dim>& mesh,
                              std::span<const SurfaceFunction> functions,
                              std::vector<Metric<Dim>>& metric_of) {
  constexpr double most_finer = Dim == 2 ? 2.8 : 2;  // of squared lengths
  std::vector<const SurfaceFunction*> of_patch(mesh.patches.size()), at(metric_of.size());
  for (const SurfaceFunction& function : functions)
    for (std::size_t p = 1; p < of_patch.size() && function.sizes; ++p)
      if (mesh.patches[p].reference == function.reference) of_patch[p] = &function;
  for (ElementId e = 0; e < mesh.element_slots() && !functions.empty(); ++e)
    for (std::size_t i = 0; i <= Dim && mesh.alive(e); ++i)
      if (const SurfaceFunction* function = of_patch[mesh.patches_of[e][i]])
        for (const VertexId v : facet_of<Dim>(mesh.corners_of[e], static_cast<int>(i)))
          at[v] = function;
  runtime::parallel_for(executor, at.size(), [&](std::size_t v) {
    if (at[v] == nullptr) return;
    std::array<double, 3> point{};
    std::copy_n(mesh.site_of[v].position.x.begin(), Dim, point.begin());
    Metric<Dim> sizes;
    std::copy_n(at[v]->sizes(point).begin(), sizes.m.size(), sizes.m.begin());
    PrincipalAxes<Dim> axes = principal_axes(sizes);
    const double least = std::ranges::min(principal_axes(metric_of[v]).value);
    bool binds = false;
    for (std::size_t i = 0; i < Dim; ++i) {
      const double asked = squared_length(metric_of[v], axes.vector[i]);
      axes.value[i] = std::max(least, std::min(axes.value[i], most_finer * asked));
      binds = binds || axes.value[i] > asked;
    }
    if (binds) metric_of[v] = intersect(metric_of[v], compose(axes));
  });
}

/// Makes the metrics keep the bounds, the curvature of boundaries and the growth that the options
/// allow. Returns sentences about what it could not do.
template <int Dim, int Space>
std::vector<std::string> limit_sizes(const runtime::Executor& executor,
                                     const Mesh<Dim, Space>& mesh, const AdaptOptions& options,
                                     std::vector<Metric<Space>>& metric_of) {
  bound_sizes(executor, metric_of, {options.smallest_size, options.largest_size});
  if (limits_growth(options) && mesh.surface)
    bound_curved_sizes(executor, mesh, options.make.hausdorff_tolerance, metric_of);
  if constexpr (Dim == Space)
    if (limits_growth(options))
      bound_sizes_by_functions<Dim>(executor, mesh, options.make.functions, metric_of);
  return limit_growth(executor, mesh, options, metric_of);
}

/// Throws unless the elements that the metric asks for can be numbered and fit in memory.
template <int Dim, int Space>
void expect_possible(const runtime::Executor& executor, const Mesh<Dim, Space>& mesh,
                     const AdaptOptions& options, const std::vector<Metric<Space>>& metric_of,
                     const std::string& name) {
  if (!options.insert) return;
  constexpr int enough_to_refine = 6;
  const double least = options.make.lock_boundary ? 0 : least_elements(executor, mesh, metric_of);
  const double elements = std::max(
      complexity_of_demand(executor, mesh, metric_of) / complexity_of_elements(Dim, 1), least);
  expect_countable(name, Dim, elements);
  const std::size_t limit =
      options.memory_limit > 0 ? options.memory_limit : runtime::most_memory();
  if (limit > 0 && options.iterations >= enough_to_refine) expect_room(name, Dim, elements, limit);
}

}  // namespace ductile::meshadapt
