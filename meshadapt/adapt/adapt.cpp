#include "ductile/meshadapt/adapt.hpp"

#include <string>
#include <vector>

#include "adapt/outer_loop.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "geometry/surface_mesh.hpp"
#include "mesh/array_lengths.hpp"
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

/// A metric that the caller has evaluated.
class GivenMetric : public MetricSource {
 public:
  explicit GivenMetric(const AnyField& metric) : metric_(metric) {}
  const AnyField* next(const AdaptState& state) override {
    return state.pass == 0 ? &metric_ : nullptr;
  }

 private:
  const AnyField& metric_;
};

/// The result is compared with the mended surface.
AdaptedMesh adapt_surface(const runtime::Executor& executor, const AnyMesh& mesh,
                          MetricSource& source, const AdaptOptions& options) {
  std::vector<std::string> warnings;
  const auto mended = mended_surface(executor, mesh, options.make, warnings);
  AdaptedMesh adapted = adapt_in<2, 3>(executor, mended ? *mended : mesh, source, options);
  auto& all = adapted.report.warnings;
  all.insert(all.begin(), warnings.begin(), warnings.end());
  return adapted;
}

}  // namespace

AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, MetricSource& source,
                  const AdaptOptions& options) {
  expect_options(options);
  expect_coordinates(mesh);
  AdaptedMesh adapted;
  runtime::with_team(executor, [&] {
    adapted = mesh.dimension == 2 ? adapt_in<2>(executor, mesh, source, options)
              : is_surface(mesh)  ? adapt_surface(executor, mesh, source, options)
                                  : adapt_in<3>(executor, mesh, source, options);
  });
  adapted.mesh.names = mesh.names;
  return adapted;
}

AdaptedMesh adapt(const runtime::Executor& executor, const AnyMesh& mesh, const AnyField& metric,
                  const AdaptOptions& options) {
  GivenMetric source(metric);
  return adapt(executor, mesh, source, options);
}

}  // namespace ductile::meshadapt
