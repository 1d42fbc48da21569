#include "ductile/meshadapt/metric_operations.hpp"

#include <string>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "metric/bounded_metric.hpp"
#include "metric/expect_metrics.hpp"
#include "metric/metric_range.hpp"
#include "metric/raise.hpp"
#include "metric/spectrum.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

double trace(const Metric<2>& a) { return a.m[0] + a.m[2]; }
double trace(const Metric<3>& a) { return a.m[0] + a.m[2] + a.m[5]; }

}  // namespace

void expect_bounds(const SizeBounds& bounds) {
  const auto [smallest, largest, anisotropy] = bounds;
  const auto is_size = [](double x) {
    return x == 0 || (x >= meshadapt::smallest_size && x <= meshadapt::largest_size);
  };
  if (!is_size(smallest) || !is_size(largest) || (largest > 0 && smallest > largest))
    throw InputError(
        "bounds on sizes: expected 0 (none) or from 1e-75 to 1e75, and the smallest not above the "
        "largest, found " +
        number(smallest) + " and " + number(largest));
  if (!(anisotropy == 0 || (anisotropy >= 1 && std::isfinite(anisotropy))))
    throw InputError("bound on the anisotropy: expected 0 (none) or 1 or more, found " +
                     number(anisotropy));
}

template <int Dim>
Metric<Dim> intersect(const Metric<Dim>& a, const Metric<Dim>& b) {
  // One that is finer everywhere has the larger trace, so it is the base, and nothing is added.
  const bool a_first = std::pair(trace(a), a.m) > std::pair(trace(b), b.m);
  Metric<Dim> result = a_first ? a : b;
  raising::raise(result, a_first ? b : a, raising::rounding);
  return result;
}

template <int Dim>
void intersect(const runtime::Executor& executor, std::vector<Metric<Dim>>& metric_of,
               const std::vector<Metric<Dim>>& other_of) {
  if (metric_of.size() != other_of.size())
    throw InputError("other_of: expected as many metrics as the " +
                     std::to_string(metric_of.size()) + " in metric_of, found " +
                     std::to_string(other_of.size()));
  expect_metrics(executor, metric_of, "metric_of");
  expect_metrics(executor, other_of, "other_of");
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    metric_of[v] = brought_into_range(intersect(metric_of[v], other_of[v]));
  });
}

template <int Dim>
void bound_sizes(const Executor& executor, std::vector<Metric<Dim>>& metric_of,
                 const SizeBounds& bounds) {
  expect_bounds(bounds);
  expect_metrics(executor, metric_of, "metric_of", bounds);
  if (!has_bounds(bounds)) return;
  runtime::parallel_for(executor, metric_of.size(), [&](std::size_t v) {
    metric_of[v] = with_bounded_sizes(metric_of[v], bounds);
  });
}

template Metric<2> intersect(const Metric<2>&, const Metric<2>&);
template Metric<3> intersect(const Metric<3>&, const Metric<3>&);
template void intersect(const runtime::Executor&, std::vector<Metric<2>>&,
                        const std::vector<Metric<2>>&);
template void intersect(const runtime::Executor&, std::vector<Metric<3>>&,
                        const std::vector<Metric<3>>&);
template void bound_sizes(const Executor&, std::vector<Metric<2>>&, const SizeBounds&);
template void bound_sizes(const Executor&, std::vector<Metric<3>>&, const SizeBounds&);
}  // namespace ductile::meshadapt
