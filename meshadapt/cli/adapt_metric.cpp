/// @file
/// The metric that `ductile adapt` adapts to: chooses its source and names it.
#include <algorithm>
#include <string>
#include <vector>

#include "adapt_job.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using runtime::Executor;

/// Makes the metric of a solution, as `ductile metric make` does.
AnyField metric_of_solution(const Executor& executor, const AdaptJob& job,
                            const meshadapt::MeshWithFields& file, meshadapt::Warnings& warnings) {
  const AnyMesh& mesh = file.mesh;
  AnyField field = side_by_side(chosen_solutions(job.solution, file, warnings), mesh);
  field.name = job.solution.back();
  meshadapt::SolutionMetricOptions options;
  options.goal.elements = job.elements;
  options.goal.bounds = {job.adapt.smallest_size, job.adapt.largest_size};
  options.gradation = std::max(job.adapt.gradation, 0.0);
  options.recovery = job.recovery;
  const auto made = meshadapt::solution_metric(executor, mesh, field, options);
  if (!made.fit.reached)
    warnings.push_back("no metric within the bounds asks for " +
                       with_commas(static_cast<std::size_t>(job.elements)) +
                       " elements; the nearest asks for about " +
                       with_commas(static_cast<std::size_t>(made.fit.elements)));
  return made.metric;
}

}  // namespace

AnyField choose_metric(const Executor& executor, const AdaptJob& job,
                       const meshadapt::MeshWithFields& file, const meshadapt::Sizes& sizes,
                       meshadapt::Warnings& warnings) {
  const AnyMesh& mesh = file.mesh;
  const meshadapt::SizeBounds bounds{job.adapt.smallest_size, job.adapt.largest_size};
  if (job.places.any())
    return meshadapt::metric_of(meshadapt::size_field(executor, mesh, sizes), mesh, bounds);
  if (!job.solution.empty()) return metric_of_solution(executor, job, file, warnings);
  if (job.adapt.curved_sizes) return meshadapt::coarsest_metric(mesh, job.adapt.largest_size);
  if (job.size) return meshadapt::constant_metric(mesh, *job.size);
  if (job.metric_in) return read_metric(*job.metric_in, mesh, warnings, bounds);
  if (const auto metric = metric_in(file); metric && !job.keep_sizes)
    return meshadapt::metric_of(*metric, mesh, bounds);
  warnings.push_back(mesh.name + ": no metric given (" +
                     (job.level_set ? "-met)" : "-sol) or found beside it") +
                     "; adapting to the sizes that the mesh has");
  return meshadapt::default_metric(executor, mesh);
}

std::string metric_said(const AdaptJob& job, const meshadapt::MeshWithFields& file) {
  if (job.places.any()) return "sizes by places";
  if (!job.solution.empty()) return "made of " + job.solution.back();
  if (job.adapt.curved_sizes) return "sizes from curved boundaries (-A)";
  if (job.size) return "the size of -hsiz everywhere";
  if (job.metric_in)
    return job.metric_in->string() + (job.metric_found ? " (found beside the mesh)"
                                      : job.level_set  ? " (given by -met)"
                                                       : " (given by -sol)");
  if (metric_in(file) && !job.keep_sizes) return "the field 'metric' of the mesh's file";
  return "the sizes that the mesh has";
}

std::vector<ValueInForce> values_in_force(const AdaptJob& job) {
  constexpr double from_curves = 1.3;  // as adapt() has it
  const meshadapt::AdaptOptions& adapt = job.adapt;
  const double gradation =
      adapt.curved_sizes && adapt.gradation == 0 ? from_curves : std::max(adapt.gradation, 0.0);
  std::vector<ValueInForce> values;
  if (job.size) values.push_back({"hsiz", *job.size});
  if (adapt.smallest_size > 0) values.push_back({"hmin", adapt.smallest_size});
  if (adapt.largest_size > 0) values.push_back({"hmax", adapt.largest_size});
  if (gradation > 0) values.push_back({"hgrad", gradation});
  if (adapt.required_gradation > 0) values.push_back({"hgradreq", adapt.required_gradation});
  if (adapt.make.hausdorff_tolerance == 0) return values;
  values.push_back({"hausd", adapt.make.hausdorff_tolerance});
  values.push_back({"ar", adapt.make.ridge_angle});
  return values;
}

}  // namespace ductile::cli
