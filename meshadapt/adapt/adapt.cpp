#include "ductile/meshadapt/adapt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "adapt/adapt_mesh.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/wording.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {
namespace {

void expect_rules(const Rules& rules) {
  for (const double rule :
       {rules.short_edge, rules.long_edge, rules.stretched_edge, rules.accepted_quality,
        rules.kept_quality, rules.poor_quality, rules.layer_split_keeps, rules.split_keeps,
        rules.overlong_edge, rules.shortest_split})
    if (!(rule >= 0 && rule <= 1e6))
      throw InputError("rules: expected thresholds from 0 to 1e6, found " + number(rule));
  if (!(rules.long_edge > rules.short_edge))
    throw InputError("rules: expected long_edge to be above short_edge, found " +
                     number(rules.long_edge) + " and " + number(rules.short_edge));
}

/// The metric with those tensors that are none within the bounds, if there are such; nothing if the
/// metric can be taken as it is. They are bounded before they are judged.
template <int Dim>
std::optional<AnyField> within_bounds(const runtime::Executor& executor, const AnyField& metric,
                                      const SizeBounds& bounds) {
  const auto tensor = [](const AnyField& field, std::size_t v) {
    Metric<Dim> one;
    std::copy_n(&field.values[v * one.m.size()], one.m.size(), one.m.begin());
    return one;
  };
  const bool all_good = first_bad(executor, metric.vertex_count, [&](std::size_t v) {
                          return !in_range(tensor(metric, v));
                        }) == no_index;
  if (all_good) return std::nullopt;
  AnyField bounded = metric;
  runtime::parallel_for(executor, metric.vertex_count, [&](std::size_t v) {
    const Metric<Dim> one = tensor(metric, v);
    if (in_range(one)) return;
    const Metric<Dim> better = meshadapt::within_bounds(one, bounds);
    std::copy_n(better.m.begin(), better.m.size(), &bounded.values[v * better.m.size()]);
  });
  return bounded;
}

void expect_options(const AdaptOptions& options) {
  if (options.iterations < 0)
    throw InputError("adaptation: expected 0 iterations or more, found " +
                     std::to_string(options.iterations));
  expect_bounds({.smallest = options.smallest_size, .largest = options.largest_size});
  expect_gradation(options.gradation);
  expect_gradation(options.required_gradation, "required_gradation");
  expect_rules(options.rules);
  if (options.make.geometry && !(options.make.hausdorff_tolerance > 0))
    throw InputError("geometry: expected a hausdorff_tolerance with it, " +
                     number(options.make.geometry->tolerance()) + ", found none");
  if (options.curved_sizes && !(options.make.hausdorff_tolerance > 0))
    throw InputError("curved_sizes: expected a hausdorff_tolerance with it, found none");
}

}  // namespace

AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options) {
  expect_options(options);
  expect_coordinates(mesh);
  if (metric.types != std::vector{AnyField::Type::symmetric} ||
      metric.dimension != mesh.dimension || metric.vertex_count != mesh.vertex_count())
    throw InputError(name_of(metric) + ": expected one symmetric tensor for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices of " + name_of(mesh));
  expect_values(metric);
  AdaptedMesh adapted;
  runtime::with_team(executor, [&] {
    const SizeBounds bounds{options.smallest_size, options.largest_size};
    std::optional<AnyField> bounded;
    if (has_bounds(bounds))
      bounded = mesh.dimension == 2 ? within_bounds<2>(executor, metric, bounds)
                                    : within_bounds<3>(executor, metric, bounds);
    const AnyField& judged = bounded ? *bounded : metric;
    mesh.dimension == 2 ? expect_metric_field<2>(executor, judged)
                        : expect_metric_field<3>(executor, judged);
    adapted = adapt_mesh(executor, mesh, judged, options);
  });
  adapted.mesh.names = mesh.names;
  return adapted;
}

}  // namespace ductile::meshadapt
