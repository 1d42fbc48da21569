/// @file
/// The input of `ductile adapt`: mesh, metric and fields, joined where that is asked for, and cut
/// along a level set.
#include <memory>
#include <utility>

#include "adapt_job.hpp"
#include "ductile/meshadapt/level_set_function.hpp"
#include "ductile/meshadapt/level_set_references.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "files.hpp"
#include "local_parameters.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::Warnings;
using runtime::Executor;

/// With --join, joins vertices that lie together, in the mesh, its metric, its level set and its
/// fields.
void join_all(const AdaptJob& job, AdaptInput& input, AnyField& level_set, Warnings& warnings) {
  if (!job.join) return;
  const auto kept = join(input.file.mesh, *job.join, warnings);
  for (AnyField* field : {&input.metric, &level_set})
    if (field->vertex_count > 0) *field = meshadapt::at_kept(*field, kept);
  keep_at(kept, input.file.fields, input.file.mesh.dimension);
  keep_at(kept, input.fields.fields, input.file.mesh.dimension);
}

void set_metric(const Executor& executor, const AdaptJob& job, AdaptInput& input,
                Warnings& warnings) {
  input.sizes = job.places.sizes_for(input.file.mesh, warnings);
  input.metric = choose_metric(executor, job, input.file, input.sizes, warnings);
}

/// True for a metric that needs no values at the vertices of the input, so that it can be made for
/// the cut mesh.
bool is_made_anew(const AdaptJob& job) {
  return job.places.any() || job.size || job.adapt.curved_sizes;
}

/// Replaces the mesh of the input, and a metric on it, by the mesh cut along the level set.
void cut_input(const Executor& executor, AdaptJob& job, AdaptInput& input,
               const AnyField& level_set, Warnings& warnings) {
  AnyMesh& mesh = input.file.mesh;
  meshadapt::CutOptions options = job.level_set->cut;
  if (const auto file = parameter_file(job.parameters, mesh))
    for (const auto& [reference, split, minus, plus] :
         meshadapt::read_level_set_references(*file, &warnings))
      options.materials.push_back({reference, split, minus, plus});
  meshadapt::CutMesh made = meshadapt::cut(executor, mesh, level_set.values, options);
  warnings.insert(warnings.end(), made.report.warnings.begin(), made.report.warnings.end());
  const double tolerance = job.adapt.make.hausdorff_tolerance;
  const bool is_curve = made.report.on_surface;  // whose model is that of its edges
  if (tolerance > 0 && made.report.interface_facets > 0 && !is_curve) {
    const meshadapt::LevelSetFunction function(executor, mesh, level_set.values, made.report.level);
    job.adapt.make.functions.push_back(function.surface(options.interface, tolerance));
  } else if (tolerance == 0 && !is_curve &&
             (job.adapt.insert || job.adapt.swap || job.adapt.move)) {
    warnings.push_back(mesh.name +
                       ": the interface keeps the facets of the cut, bad elements among them; "
                       "-hausd X lets it be up to X from the surface of the level set");
  }
  if (!is_made_anew(job)) input.metric = meshadapt::metric_at_cut(executor, input.metric, made);
  input.cut = cut_report(*job.level_set, options, made.report);
  input.cut->before = std::exchange(mesh, std::move(made.mesh));
  if (is_made_anew(job)) set_metric(executor, job, input, warnings);
}

}  // namespace

AdaptInput read_input(const Executor& executor, AdaptJob& job, Warnings& warnings) {
  if (!job.unneeded.empty()) warnings.push_back(job.unneeded);
  AdaptInput input;
  input.file = meshadapt::read_mesh_with_fields(job.input, &warnings);
  const AnyMesh& mesh = input.file.mesh;
  AnyField level_set;
  if (job.level_set) level_set = read_level_set(*job.level_set, input.file, warnings);
  if (!job.level_set || !is_made_anew(job)) set_metric(executor, job, input, warnings);
  input.fields = job.fields.read(mesh, warnings);
  input.in_force = {metric_said(job, input.file), values_in_force(job)};
  join_all(job, input, level_set, warnings);
  warn_of_loose_vertices(executor, mesh, warnings);
  if (job.level_set) cut_input(executor, job, input, level_set, warnings);
  if (!job.places.any())
    bound_locally(executor, mesh, local_parameters(job.parameters, mesh, job.adapt, warnings),
                  input.metric, job.adapt);
  return input;
}

std::shared_ptr<const meshadapt::Geometry> read_geometry(const Executor& executor,
                                                         const AdaptJob& job, Warnings& warnings) {
  if (!job.geometry) return nullptr;
  const meshadapt::MakeMeshOptions& make = job.adapt.make;
  return std::make_shared<const meshadapt::Geometry>(
      executor, meshadapt::read_mesh(*job.geometry, &warnings),
      meshadapt::GeometryOptions{.tolerance = make.hausdorff_tolerance,
                                 .ridge_angle = make.ridge_angle,
                                 .complete_boundary = make.complete_boundary});
}

}  // namespace ductile::cli
