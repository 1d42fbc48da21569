/// @file
/// The input of `ductile adapt`: mesh, metric and fields, joined where that is asked for, and cut
/// along a level set.
#include <algorithm>
#include <array>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "adapt_job.hpp"
#include "ductile/meshadapt/level_set_function.hpp"
#include "ductile/meshadapt/level_set_references.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

using runtime::Executor;

// ---- Local parameters ----

std::optional<fs::path> file_beside(const AnyMesh& mesh) {
  const std::string ending = mesh.dimension == 2 ? ".mmg2d" : ".mmg3d";
  std::error_code ignored;
  for (fs::path path :
       {fs::path(mesh.name).replace_extension(ending), fs::path("DEFAULT" + ending)})
    if (fs::is_regular_file(path, ignored)) return path;
  return std::nullopt;
}

/// Mmg looks for FILE with the ending of its own, whatever FILE has.
fs::path file_given(const fs::path& given, const AnyMesh& mesh) {
  std::error_code ignored;
  fs::path other = given;
  other.replace_extension(mesh.dimension == 2 ? ".mmg2d" : ".mmg3d");
  return !fs::exists(given, ignored) && fs::exists(other, ignored) ? other : given;
}

bool has_reference(const AnyMesh& mesh, const LocalSize& local) {
  const std::array references{&mesh.vertex_reference, &mesh.edges.reference,
                              &mesh.triangles.reference, &mesh.tetrahedra.reference};
  const auto& among = *references.at(static_cast<std::size_t>(local.dimension));
  return std::ranges::find(among, local.reference) != among.end();
}

void warn_of_parameters(const std::string& file, const std::vector<LocalSize>& local_sizes,
                        const AnyMesh& mesh, double hausdorff_tolerance, Warnings& warnings) {
  std::vector<std::int32_t> missing;
  bool tolerances = false;
  for (const LocalSize& local : local_sizes) {
    if (!has_reference(mesh, local)) missing.push_back(local.reference);
    tolerances |= local.hausdorff_tolerance > 0 && local.hausdorff_tolerance != hausdorff_tolerance;
  }
  if (!missing.empty())
    warnings.push_back(file + ": nothing in the mesh has the references " + listed(missing));
  if (tolerances)
    warnings.push_back(file +
                       ": left out hausd, which is the same for all boundaries here (-hausd)");
}

/// Widens the bounds to include all local ones.
void widen(AdaptOptions& adapt, const std::vector<LocalSize>& local_sizes) {
  for (const LocalSize& local : local_sizes) {
    if (local.smallest > 0) adapt.smallest_size = std::min(adapt.smallest_size, local.smallest);
    if (local.largest > 0) adapt.smallest_size = std::min(adapt.smallest_size, local.largest);
    if (adapt.largest_size > 0)
      adapt.largest_size = std::max({adapt.largest_size, local.largest, local.smallest});
  }
}

/// The file of local parameters, if there is one: the one given with -f or, as Mmg does, NAME.mmg2d
/// or NAME.mmg3d beside the mesh, otherwise DEFAULT.mmg2d or DEFAULT.mmg3d.
std::optional<fs::path> parameter_file(const std::optional<fs::path>& given, const AnyMesh& mesh) {
  return given ? file_given(*given, mesh) : file_beside(mesh);
}

/// The sizes in that file. Warns of a file that was found without -f, and of parameters without
/// effect. Throws InputError.
std::vector<LocalSize> local_parameters(const std::optional<fs::path>& given, const AnyMesh& mesh,
                                        const AdaptOptions& adapt, Warnings& warnings) {
  const std::optional<fs::path> file = parameter_file(given, mesh);
  if (!file) return {};
  std::vector<LocalSize> local_sizes = read_local_sizes(*file, &warnings);
  for (const LocalSize& local : local_sizes)
    if (local.dimension > mesh.dimension)
      throw InputError(file->string() + ": expected entities of a mesh of dimension " +
                       std::to_string(mesh.dimension) + ", found tetrahedra");
  if (!given) warnings.push_back(file->string() + ": local parameters found; they bound sizes");
  warn_of_parameters(file->string(), local_sizes, mesh, adapt.make.hausdorff_tolerance, warnings);
  return local_sizes;
}

/// Bounds the metric by local bounds and elsewhere by those in `adapt`, which are then widened to
/// include all. Without local bounds nothing changes.
void bound_locally(const runtime::Executor& executor, const AnyMesh& mesh,
                   const std::vector<LocalSize>& local_sizes, AnyField& metric,
                   AdaptOptions& adapt) {
  if (local_sizes.empty()) return;
  metric = bound_sizes_locally(executor, mesh, metric, local_sizes,
                               {adapt.smallest_size, adapt.largest_size});
  widen(adapt, local_sizes);
}

// ---- The mesh ----

/// With --join, joins vertices that lie together, in the mesh, its metric, its level set and its
/// fields.
void join_all(const AdaptJob& job, AdaptInput& input, AnyField& level_set, Warnings& warnings) {
  if (!job.join) return;
  const auto kept = join(input.file.mesh, *job.join, warnings);
  for (AnyField* field : {&input.metric, &level_set})
    if (field->vertex_count > 0) *field = at_kept(*field, kept);
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
  CutOptions options = job.level_set->cut;
  if (const auto file = parameter_file(job.parameters, mesh))
    for (const auto& [reference, split, minus, plus] : read_level_set_references(*file, &warnings))
      options.materials.push_back({reference, split, minus, plus});
  CutMesh made = cut(executor, mesh, level_set.values, options);
  warnings.insert(warnings.end(), made.report.warnings.begin(), made.report.warnings.end());
  const double tolerance = job.adapt.make.hausdorff_tolerance;
  const bool is_curve = made.report.on_surface;  // whose model is that of its edges
  if (tolerance > 0 && made.report.interface_facets > 0 && !is_curve) {
    const LevelSetFunction function(executor, mesh, level_set.values, made.report.level);
    job.adapt.make.functions.push_back(function.surface(options.interface, tolerance));
  } else if (tolerance == 0 && !is_curve &&
             (job.adapt.insert || job.adapt.swap || job.adapt.move)) {
    warnings.push_back(mesh.name +
                       ": the interface keeps the facets of the cut, bad elements among them; "
                       "-hausd X lets it be up to X from the surface of the level set");
  }
  if (!is_made_anew(job)) input.metric = metric_at_cut(executor, input.metric, made);
  input.cut = cut_report(*job.level_set, options, made.report);
  input.cut->before = std::exchange(mesh, std::move(made.mesh));
  if (is_made_anew(job)) set_metric(executor, job, input, warnings);
}

}  // namespace

AdaptInput read_input(const Executor& executor, AdaptJob& job, Warnings& warnings) {
  if (!job.unneeded.empty()) warnings.push_back(job.unneeded);
  AdaptInput input;
  input.file = read_mesh_with_fields(job.input, &warnings);
  const AnyMesh& mesh = input.file.mesh;
  AnyField level_set;
  if (job.level_set) level_set = read_level_set(*job.level_set, input.file, warnings);
  if (!job.level_set || !is_made_anew(job)) set_metric(executor, job, input, warnings);
  input.fields = job.fields.read(mesh, warnings);
  input.in_force = metric_in_force(job, input.file);
  join_all(job, input, level_set, warnings);
  warn_of_loose_vertices(executor, mesh, warnings);
  if (job.level_set) cut_input(executor, job, input, level_set, warnings);
  if (!job.places.any())
    bound_locally(executor, mesh, local_parameters(job.parameters, mesh, job.adapt, warnings),
                  input.metric, job.adapt);
  return input;
}

std::shared_ptr<const Geometry> read_geometry(const Executor& executor, const AdaptJob& job,
                                              Warnings& warnings) {
  if (!job.geometry) return nullptr;
  const MakeMeshOptions& make = job.adapt.make;
  return std::make_shared<const Geometry>(
      executor, read_mesh(*job.geometry, &warnings),
      GeometryOptions{.tolerance = make.hausdorff_tolerance,
                      .ridge_angle = make.ridge_angle,
                      .complete_boundary = make.complete_boundary});
}

// ---- The metric: chooses its source and names it ----

namespace {

/// Makes the metric of a solution, as `ductile metric make` does.
AnyField metric_of_solution(const Executor& executor, const AdaptJob& job,
                            const MeshWithFields& file, Warnings& warnings) {
  const AnyMesh& mesh = file.mesh;
  AnyField field = side_by_side(chosen_solutions(job.solution, file, warnings), mesh);
  field.name = job.solution.back();
  SolutionMetricOptions options;
  options.goal.elements = job.elements;
  options.goal.bounds = {job.adapt.smallest_size, job.adapt.largest_size};
  options.gradation = std::max(job.adapt.gradation, 0.0);
  options.recovery = job.recovery;
  const auto made = solution_metric(executor, mesh, field, options);
  if (!made.fit.reached)
    warnings.push_back("no metric within the bounds asks for " +
                       with_commas(static_cast<std::size_t>(job.elements)) +
                       " elements; the nearest asks for about " +
                       with_commas(static_cast<std::size_t>(made.fit.elements)));
  return made.metric;
}

}  // namespace

AnyField choose_metric(const Executor& executor, const AdaptJob& job, const MeshWithFields& file,
                       const Sizes& sizes, Warnings& warnings) {
  const AnyMesh& mesh = file.mesh;
  const SizeBounds bounds{job.adapt.smallest_size, job.adapt.largest_size};
  if (job.places.any()) return metric_of(size_field(executor, mesh, sizes), mesh, bounds);
  if (!job.solution.empty()) return metric_of_solution(executor, job, file, warnings);
  if (job.adapt.curved_sizes) return coarsest_metric(mesh, job.adapt.largest_size);
  if (job.size) return constant_metric(mesh, *job.size);
  if (job.metric_in) return read_metric(*job.metric_in, mesh, warnings, bounds);
  if (const auto metric = metric_in(file); metric && !job.keep_sizes)
    return metric_of(*metric, mesh, bounds);
  warnings.push_back(mesh.name + ": no metric given (" +
                     (job.level_set ? "-met)" : "-sol) or found beside it") +
                     "; adapting to the sizes that the mesh has");
  return default_metric(executor, mesh);
}

namespace {

/// "part.sol (found beside the mesh)".
std::string source_of(const AdaptJob& job, const MeshWithFields& file) {
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

}  // namespace

MetricInForce metric_in_force(const AdaptJob& job, const MeshWithFields& file) {
  constexpr double from_curves = 1.3;  // as adapt() has it
  const AdaptOptions& adapt = job.adapt;
  const double gradation =
      adapt.curved_sizes && adapt.gradation == 0 ? from_curves : std::max(adapt.gradation, 0.0);
  const bool curved = adapt.make.hausdorff_tolerance > 0;
  MetricInForce in_force{source_of(job, file),
                         {{"hsiz", job.size.value_or(0)},
                          {"hmin", adapt.smallest_size},
                          {"hmax", adapt.largest_size},
                          {"hgrad", gradation},
                          {"hgradreq", adapt.required_gradation},
                          {"hausd", adapt.make.hausdorff_tolerance},
                          {"ar", curved ? adapt.make.ridge_angle : 0}}};
  std::erase_if(in_force.values, [](const auto& one) { return one.second <= 0; });
  return in_force;
}

}  // namespace ductile::cli
