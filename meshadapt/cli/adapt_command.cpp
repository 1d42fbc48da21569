#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <new>

#include "adapt_job.hpp"
#include "checks/faults.hpp"
#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/runtime/process.hpp"
#include "extents.hpp"
#include "files.hpp"
#include "mmg_options.hpp"
#include "progress_bar.hpp"

namespace ductile::cli {

namespace {

using runtime::Executor;
using Job = AdaptJob;

constexpr std::array<Option, 50> own_options{{
    heading("Input and output"),
    {"-o", "OUT", "where the adapted mesh goes (default: NAME.o.mesh, or as the input is)",
     "--out"},
    {"--field", "FIELD", "carries fields to OUT.FIELD.sol, integrals kept; may be given again"},
    {"--interpolate", "", "carries fields by their values; integrals change"},
    {"--no-metric", "", "writes no metric beside the adapted mesh"},
    {"--vtu", "FILE", "writes the adapted mesh for ParaView, too, a .vtu"},
    {"--json", "FILE", "writes counts, times, quality and memory there, a .json, or - for output"},
    {"--join", "X", "makes one of vertices that are at most X from each other; 0: at one place"},
    {"--complete-boundary", "", "gives boundary facets missing in the file reference 0"},
    heading("Sizes"),
    {"-sol", "FIELD",
     "the metric or the sizes wanted, with -ls the level set (default: NAME.sol or .solb)"},
    {"-met", "FIELD", "the same as -sol; with -ls, the metric"},
    {"-hsiz", "X", "asks for edges of length X everywhere"},
    {"--solution", "FIELD",
     "the metric that suits this field of MESH, or of a file, with --elements elements"},
    {"--elements", "N", "with --solution: about how many elements to have"},
    {"--recovery", "least-squares|projection",
     "with --solution: how to get second derivatives (default: least-squares)"},
    {"--near", "PLACE:H[:GROW]",
     "asks for H near a place (ductile help metric), -hsiz elsewhere; may be given again"},
    {"--on", "BOUNDARY:H[:GROW]", "asks for H on a boundary, by its reference or name; likewise"},
    {"--inside", "REGION:H[:GROW]", "asks for H in a region, instead of -hsiz; likewise"},
    {"-hmin", "X", "asks for no edge shorter than X"},
    {"-hmax", "X", "asks for no edge longer than X"},
    {"-hgrad", "X", "lets sizes grow by a factor of X at most per unit length (default: no limit)"},
    {"-hgradreq", "X",
     "sizes start at those of required entities and change by X at most (default: as asked)"},
    {"-f", "FILE",
     "bounds on sizes by reference, materials of -ls, a .mmg2d or .mmg3d (default: NAME's)"},
    heading("Geometry"),
    {"-hausd", "X", "lets curved boundaries be up to X from where they were (default: not at all)"},
    {"-geometry", "FILE", "with -hausd: measures X from the boundaries in FILE, a mesh"},
    {"-A", "",
     "with -hausd: sizes from how boundaries are curved, up to -hmax, growing by -hgrad (1.3)"},
    {"-ar", "DEG", "with -hausd: keeps edges that turn by DEG degrees as ridges (default: 45)"},
    {"-nosurf", "", "leaves the boundary and interfaces as they are"},
    heading("Level sets"),
    {"-ls", "[V]", "cuts the mesh first where -sol, a file or a field of MESH, is V (0)"},
    {"-lssurf", "[V]", "the same for the triangles of the boundary alone, with references by side"},
    {"-rmc", "[X]", "with -ls, removes components with less than X of the volume (1e-5)"},
    {"-isoref", "N", "with -ls, facets where it is V get this reference (10)"},
    {"--keep-volume", "X", "with -ls, changes V so that the part below has this volume"},
    heading("Motion"),
    {"-lag", "N",
     "moves the mesh by the vectors of -sol (ductile help move); adapts it 0: not, 1: by swaps, 2: "
     "fully"},
    heading("Quality"),
    {"--iterations", "N", "at most this many rounds of all kernels"},
    {"--thorough", "", "goes on for better shapes and lengths"},
    {"-nomove", "", "moves no vertex"},
    {"-noswap", "", "swaps no edge or face"},
    {"-noinsert", "", "splits and collapses no edge"},
    {"--by-colours", "", "the published method, by classes of a colouring; slower"},
    {"--racing", "", "with --by-colours, in order of arrival: runs may differ"},
    heading("Running"),
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
    {"-m", "MB", "takes at most this much memory, in megabytes", "--memory"},
    {"-v", "N", "0 says nothing, 1 (default) sums up, 2 says more", "--verbose"},
}};

/// The options above, and those of Mmg that have no effect.
constexpr auto options = [] {
  std::array<Option, own_options.size() + mmg_options.size()> all;
  const auto rest = std::copy(own_options.begin(), own_options.end(), all.begin());
  std::copy(mmg_options.begin(), mmg_options.end(), rest);
  return all;
}();

}  // namespace

std::size_t memory_left(std::optional<std::size_t> given) {
  const std::size_t most = given ? *given : runtime::most_memory(), held = runtime::held_memory();
  return most == 0 ? 0 : most - std::min(held, most - 1);
}

namespace {

AdaptedMesh adapt_with_progress(const Executor& executor, const Job& job, const AnyMesh& mesh,
                                const AnyField& metric, const Sizes& sizes) {
  ProgressBar bar(job.verbosity > 0 && stderr_is_terminal());
  AdaptOptions options_of_job = job.adapt;
  options_of_job.memory_limit = memory_left(job.memory);
  options_of_job.progress = [&bar](const AdaptProgress& progress) {
    bar.show(progress);
    return true;
  };
  return !job.places.any() ? adapt(executor, mesh, metric, options_of_job)
                           : adapt_to_sizes(executor, mesh, sizes, options_of_job);
}

void expect_right(const AdjacentMesh& before, const AdjacentMesh& after,
                  double hausdorff_tolerance) {
  const auto faults = adapted_faults(before, after, hausdorff_tolerance);
  if (!faults.empty())
    throw Error("the adapted mesh is not valid (" + faults.front() +
                "); nothing was written; please report this with its input");
}

std::string what_was_done(const Job& job, const AdaptInput& input, const AdaptSummary& summary) {
  return (input.cut ? to_text(*input.cut) : std::string()) + to_text(summary, job.verbosity > 1) +
         written(job);
}

bool is_level_set(const Job& job, const NamedField& field) {
  return job.level_set && job.level_set->values.value_or(field.name) == field.name;
}

void warn_of_fields_left(const Job& job, const MeshWithFields& file, Warnings& warnings) {
  std::vector<std::string> left;
  for (const NamedField& field : file.fields)
    if (field.name != "metric" && !is_level_set(job, field)) left.push_back(field.name);
  if (!left.empty() && job.fields.inputs().empty())
    warnings.push_back(
        file.mesh.name + ": its fields are not carried: " + listed(left) +
        "; --field takes those at the vertices of a file along, ductile transfer all");
}

/// How far curved boundaries are from where they were. If memory runs out here, that is not told,
/// because the mesh itself is there.
std::optional<double> distance_from(const Executor& executor, const AnyMesh& before,
                                    const AnyMesh& after, const MakeMeshOptions& make) {
  try {
    if (make.geometry) return distance_to(executor, after, *make.geometry);
    return distance_to(executor, after,
                       Geometry(executor, before,
                                {.tolerance = make.hausdorff_tolerance,
                                 .ridge_angle = make.ridge_angle,
                                 .complete_boundary = make.complete_boundary,
                                 .functions = make.functions}));
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

AdaptSummary summary_of(const Job& job, const AdaptInput& input, const AdjacentMesh& before,
                        const AdaptedMesh& adapted, const AdjacentMesh& after) {
  const MakeMeshOptions& make = job.adapt.make;
  const double tolerance = make.lock_boundary ? 0 : make.hausdorff_tolerance;
  const bool tells = job.json || job.verbosity > 0;
  AdaptSummary summary =
      summarise(before, input.metric, adapted, after,
                {.before = job.json || job.verbosity > 1,
                 .after = tells,
                 .expects_lengths = job.adapt.insert,
                 .keeps_surface = make.hausdorff_tolerance == 0 && !make.lock_boundary,
                 .hausdorff_tolerance = tolerance,
                 .in_force = input.in_force});
  if (!tells) return summary;
  summary.ridges = ridge_count(adapted.mesh, make.ridge_angle);
  if (tolerance > 0)
    summary.distance = distance_from(after.executor(), before.mesh(), adapted.mesh, make);
  return summary;
}

int work(const Executor& executor, Job job) {
  const auto begin = std::chrono::steady_clock::now();
  if (job.memory) limit_memory(*job.memory);  // which OpenMP must have its threads before
  Warnings warnings;
  const AdaptInput input = read_input(executor, job, warnings);
  const AnyMesh& mesh = input.file.mesh;
  warn_of_fields_left(job, input.file, warnings);
  job.adapt.make.geometry = read_geometry(executor, job, warnings);

  AdaptedMesh adapted = adapt_with_progress(executor, job, mesh, input.metric, input.sizes);
  const AdjacentMesh before(executor, mesh), after(executor, adapted.mesh);
  if (!adapted.report.checked) expect_right(before, after, job.adapt.make.hausdorff_tolerance);
  adapted.mesh.name = job.output.string();
  const auto carried =
      job.fields.carry(executor, input.mesh_of_fields(), input.fields, adapted.mesh);
  const AdaptSummary summary = summary_of(job, input, before, adapted, after);
  warnings.insert(warnings.end(), summary.report.warnings.begin(), summary.report.warnings.end());
  const std::string said = job.verbosity > 0 ? what_was_done(job, input, summary) : std::string();
  write_outputs(job,
                {adapted.mesh, adapted.metric, carried, input.fields.count_of,
                 [&] { return to_json(summary, input.cut ? to_json(*input.cut) : Json()); }},
                warnings);
  // From here on no memory is taken, because the outputs are there.
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  if (!said.empty())
    std::fprintf(messages_of(job), "%s (%.2f s in all)\n", said.c_str(), passed.count());
  return done;
}

int run(const Arguments& arguments) {
  if (arguments.has("-lag")) return run_lag(arguments);
  Job job = adapt_job(arguments);
  check_files(job);
  return run_in_team({.threads = job.threads, .deterministic = !job.racing},
                     [&](const Executor& executor) { return work(executor, job); });
}

}  // namespace

const Command adapt_command{
    "adapt",
    "MESH [-sol METRIC] [-o OUT]",
    "adapts a mesh to a metric",
    "The metric is a size or a tensor at each vertex; edges get a length of about one in it, and "
    "it\n"
    "is written beside the adapted mesh. Without any, the sizes that the mesh has are kept. Sizes\n"
    "by places are evaluated on the adapted mesh, too, which is adapted again while it lacks "
    "some,\n"
    "at most five times in all. Along a level set the mesh is cut first: references are 3 below V, "
    "2\n"
    "above and 10 between; with -hausd the interface is adapted to its curved surface.",
    options,
    run};

}  // namespace ductile::cli
