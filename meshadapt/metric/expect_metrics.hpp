/// @file
/// Checks that the tensors of a caller are metrics, before anything relies on it: an invalid one
/// has no real roots, and kernels might not end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "mesh/wording.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/metric_range.hpp"

namespace ductile::meshadapt {

inline const char* const what_metrics_are =
    "expected a positive definite tensor, of sizes from 1e-75 to 1e75 that differ by at most 1e8 "
    "times, ";

/// Throws InputError, naming the array and the first that is wrong, unless all are metrics, or are
/// once bounds hold.
template <int Dim>
void expect_metrics(const runtime::Executor& executor, const std::vector<Metric<Dim>>& metric_of,
                    const std::string& array, const SizeBounds& bounds = {}) {
  const std::size_t bad = first_bad(executor, metric_of.size(), [&](std::size_t v) {
    return !in_range(metric_of[v]) && !in_range(within_bounds(metric_of[v], bounds));
  });
  if (bad == no_index) return;
  std::string found;
  for (const double component : metric_of[bad].m)
    found += (found.empty() ? "" : " ") + number(component);
  refuse(std::string(what_metrics_are) + "found another at " + entry(array, "vertex", bad) + ": " +
         found);
}

/// The same for a field of one symmetric tensor at each vertex, which has all its values.
template <int Dim>
void expect_metric_field(const runtime::Executor& executor, const AnyField& field,
                         const SizeBounds& bounds = {}) {
  const std::size_t bad = first_bad(executor, field.vertex_count, [&](std::size_t v) {
    Metric<Dim> metric;
    std::copy_n(&field.values[v * Metric<Dim>::size], Metric<Dim>::size, metric.m.begin());
    return !in_range(metric) && !(has_bounds(bounds) && in_range(within_bounds(metric, bounds)));
  });
  if (bad != no_index)
    refuse(name_of(field) + ": " + what_metrics_are + "found another at " + value_at(field, bad) +
           "; correct the metric there");
}

/// As expect_metrics(), for each of so many vertices.
template <int Dim>
void expect_metric_everywhere(const runtime::Executor& executor,
                              const std::vector<Metric<Dim>>& metric_of, std::size_t vertices,
                              const std::string& array) {
  expect_at_each_vertex(array + ": expected a metric", vertices, metric_of.size());
  expect_metrics(executor, metric_of, array);
}

}  // namespace ductile::meshadapt
