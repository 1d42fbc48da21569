#include "ductile/meshadapt/adapt.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/team.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/first_bad.hpp"
#include "metric/judge_metric.hpp"
#include "metric/spectrum.hpp"
#include "operators/processor_level.hpp"

namespace ductile::meshadapt {
namespace {

/// Of what metric_of checks that which costs nothing: rounding decides whether a thin metric is
/// positive definite.
void expect_numbers(const runtime::Executor& executor, const AnyField& metric) {
  const std::size_t stride = stride_of(metric);
  if (metric.values.size() != stride * metric.vertex_count)
    throw InputError(metric.name + ": expected " + std::to_string(stride * metric.vertex_count) +
                     " numbers, those of all tensors, found " +
                     std::to_string(metric.values.size()));
  const std::size_t bad = first_bad(executor, metric.vertex_count, [&](std::size_t v) {
    const double* m = &metric.values[v * stride];
    // Sizes from 1e-75 to 1e75 and their rounding, as metric_of has it.
    const auto within = [](double x) { return x > 1e-151 && x < 1e151; };
    const bool positive = within(m[0]) && within(m[2]) && (stride == 3 || within(m[5]));
    return !positive || !std::all_of(m, m + stride, [](double x) { return std::isfinite(x); });
  });
  if (bad < metric.vertex_count)
    throw InputError(
        metric.name +
        ": expected a positive definite tensor, of sizes from 1e-75 to 1e75, at vertex " +
        std::to_string(bad + 1) + ", found one that is not; correct the metric there");
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
                          return !is_metric(tensor(metric, v));
                        }) == no_index;
  if (all_good) return std::nullopt;
  AnyField bounded = metric;
  runtime::parallel_for(executor, metric.vertex_count, [&](std::size_t v) {
    const Metric<Dim> one = tensor(metric, v);
    if (is_metric(one)) return;
    const Metric<Dim> better = meshadapt::within_bounds(one, bounds);
    std::copy_n(better.m.begin(), better.m.size(), &bounded.values[v * better.m.size()]);
  });
  return bounded;
}

void expect_options(const AdaptOptions& options) {
  if (options.iterations < 0)
    throw InputError("adaptation: expected 0 iterations or more, found " +
                     std::to_string(options.iterations));
  for (const double size : {options.smallest_size, options.largest_size})
    if (!std::isfinite(size))
      throw InputError("adaptation: expected finite bounds on sizes, or 0 for none");
  expect_bounds({.smallest = options.smallest_size, .largest = options.largest_size});
  expect_gradation(options.gradation);
}

}  // namespace

AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options) {
  expect_options(options);
  expect_coordinates(mesh);
  if (metric.types != std::vector{AnyField::Type::symmetric} ||
      metric.dimension != mesh.dimension || metric.vertex_count != mesh.vertex_count())
    throw InputError(metric.name + ": expected one symmetric tensor for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices of " + mesh.name);
  AdaptedMesh adapted;
  runtime::with_team(executor, [&] {
    const SizeBounds bounds{options.smallest_size, options.largest_size};
    std::optional<AnyField> bounded;
    if (has_bounds(bounds) && metric.values.size() == stride_of(metric) * metric.vertex_count)
      bounded = mesh.dimension == 2 ? within_bounds<2>(executor, metric, bounds)
                                    : within_bounds<3>(executor, metric, bounds);
    const AnyField& judged = bounded ? *bounded : metric;
    expect_numbers(executor, judged);
    adapted = adapt_at(usable_levels().front(), executor, mesh, judged, options);
  });
  return adapted;
}

}  // namespace ductile::meshadapt
