#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "adapt_job.hpp"
#include "adapt_report.hpp"
#include "carried_fields.hpp"
#include "checks/faults.hpp"
#include "command.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/metric_operations.hpp"
#include "ductile/meshadapt/sizes.hpp"
#include "ductile/runtime/process.hpp"
#include "files.hpp"
#include "local_parameters.hpp"
#include "mmg_options.hpp"
#include "move_command.hpp"
#include "recovery_option.hpp"
#include "run_in_team.hpp"
#include "size_options.hpp"
#include "system.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::AdaptedMesh;
using meshadapt::AdaptOptions;
using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::MakeMeshOptions;
using runtime::Executor;
using Job = AdaptJob;

constexpr std::array<Option, 43> own_options{{
    {"-sol", "FIELD",
     "the metric or the sizes wanted, with -ls the level set (default: NAME.sol or .solb)"},
    {"-met", "FIELD", "the same as -sol; with -ls, the metric"},
    {"-o", "OUT", "where the adapted mesh goes (default: NAME.o.mesh, or as the input is)",
     "--out"},
    {"-hsiz", "X", "asks for edges of length X everywhere"},
    {"--solution", "FIELD",
     "the metric in which this field of MESH, or of a file, is resolved by --elements elements"},
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
     "takes sizes from what is required, to grow and fall by X at most (default: as asked)"},
    {"-f", "FILE",
     "bounds on sizes by reference, materials of -ls, a .mmg2d or .mmg3d (default: NAME's)"},
    {"-nomove", "", "moves no vertex"},
    {"-noswap", "", "swaps no edge or face"},
    {"-noinsert", "", "splits and collapses no edge"},
    {"-lag", "N",
     "moves the mesh by the vectors of -sol (ductile help move); 0: without adapting it, 1, 2: "
     "with"},
    {"-nosurf", "", "leaves the boundary and interfaces as they are"},
    {"-hausd", "X", "lets curved boundaries be up to X from where they were (default: not at all)"},
    {"-geometry", "FILE",
     "with -hausd: they are up to X from the boundaries in FILE, a mesh, not from where they were"},
    {"-A", "",
     "with -hausd: sizes from how boundaries are curved, up to -hmax, growing by -hgrad (1.3)"},
    {"-ar", "DEG",
     "with -hausd, edges that turn by DEG degrees are ridges, which stay (default: 45)"},
    {"-ls", "[V]", "cuts the mesh first where -sol, a file or a field of MESH, is V (0)"},
    {"-lssurf", "[V]", "the same for the triangles of the boundary alone, with references by side"},
    {"-rmc", "[X]", "with -ls, removes components with less than X of the volume (1e-5)"},
    {"-isoref", "N", "with -ls, facets where it is V get this reference (10)"},
    {"--keep-volume", "X", "with -ls, changes V so that the part below has this volume"},
    {"-v", "N", "0 says nothing, 1 (default) sums up, 2 says more", "--verbose"},
    {"-m", "MB", "takes at most this much memory, in megabytes", "--memory"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
    {"--iterations", "N", "at most this many rounds of all kernels"},
    {"--thorough", "", "goes on for better shapes and lengths"},
    {"--by-colours", "",
     "as published: kernels by classes of a colouring, deferred updates; slower"},
    {"--racing", "", "with --by-colours, in order of arrival: runs may differ"},
    {"--json", "FILE", "writes counts, times, quality and memory there, a .json, or - for output"},
    {"--vtu", "FILE", "writes the adapted mesh for ParaView, too, a .vtu"},
    {"--join", "X", "makes one of vertices that are at most X from each other; 0: at one place"},
    {"--complete-boundary", "", "gives boundary facets missing in the file reference 0"},
    {"--no-metric", "", "writes no metric beside the adapted mesh"},
    {"--field", "FIELD", "carries fields to OUT.FIELD.sol, integrals kept; may be given again"},
    {"--interpolate", "", "carries fields by their values, whatever becomes of integrals"},
}};

/// The options above, and those of Mmg that have no effect.
constexpr auto options = [] {
  std::array<Option, own_options.size() + mmg_options.size()> all;
  const auto rest = std::copy(own_options.begin(), own_options.end(), all.begin());
  std::copy(mmg_options.begin(), mmg_options.end(), rest);
  return all;
}();

fs::path only_mesh(const Arguments& arguments) {
  std::vector<std::string> meshes = arguments.operands();
  if (const auto mesh = arguments.text("-in")) meshes.push_back(*mesh);
  if (meshes.size() != 1)
    throw UsageError("expected one mesh, found " + std::to_string(meshes.size()) +
                     (meshes.size() == 2 ? "; -o says where the adapted one goes" : ""));
  return input_of(meshes[0]);
}

/// Sets where the mesh goes and, unless that is standard output, the metric beside it.
void set_output(Job& job, const Arguments& arguments, const std::optional<fs::path>& given) {
  const auto out = arguments.text("-o");
  if (!given && !out && job.input == "/dev/stdin")
    throw UsageError("expected -o, because the mesh is read from standard input, found none");
  job.output = given ? *given : out ? output_of(*out) : default_output(job.input);
  expect_mesh_name(job.output);
  job.with_metric = !arguments.has("--no-metric");
  if (holds_fields(job.output)) return;
  if (is_standard_output(job.output) && arguments.has("--field"))
    throw UsageError(
        "option --field: expected an output beside which fields can be, or -.vtu, found " +
        job.output.string());
  if (job.with_metric && !is_standard_output(job.output)) job.metric_out = field_beside(job.output);
}

/// Sizes are given in at most one way; otherwise a metric beside the mesh is used, if there is one.
void set_sizes(Job& job, const Arguments& arguments) {
  job.size = size_option(arguments, "-hsiz");
  job.places = SizeOptions(arguments, "-hsiz");
  job.level_set = level_set_option(arguments);
  job.metric_in = arguments.text("-met");
  if (!job.metric_in && !job.level_set) job.metric_in = arguments.text("-sol");
  job.keep_sizes = arguments.has("-optim");
  std::vector<std::string> given;
  const auto add = [&](const char* option) {
    if (arguments.has(option)) given.emplace_back(option);
  };
  add("-optim");
  add("-A");
  if (job.places.any() && !job.level_set) add("-f");
  if (!job.places.any()) add("-hsiz");
  if (!job.level_set) add("-sol");
  add("-met");
  add("--solution");
  for (const char* option : {"--near", "--on", "--inside"})  // which are one way together
    if (given.empty() || !given.back().starts_with("--")) add(option);
  if (given.size() > 1)
    throw UsageError("options " + given[0] + " and " + given[1] +
                     ": expected one of them, found both");
  if (arguments.has("-A") && !arguments.has("-hausd"))
    throw UsageError(
        "option -A: expected -hausd, which says how far from curved boundaries edges may be, found "
        "none");
  if (const auto field = arguments.text("--solution")) job.solution = {*field};
  job.elements = arguments.positive("--elements").value_or(0);
  if (job.solution.empty() != (job.elements == 0))
    throw UsageError("options --solution and --elements: expected both or none, found one");
  job.recovery = recovery_in(arguments);
  if (job.solution.empty() && arguments.has("--recovery"))
    throw UsageError("option --recovery: expected --solution as well, found none");
  job.metric_found = given.empty() && !job.level_set;
}

void set_files(Job& job, const Arguments& arguments, const std::optional<fs::path>& output) {
  job.input = only_mesh(arguments);
  set_output(job, arguments, output);
  job.json = json_output(arguments);
  if (job.json == standard_output && is_standard_output(job.output))
    throw UsageError("option --json: expected a file, because the mesh goes to standard output");
  job.join = join_option(arguments);
  job.vtu = arguments.text("--vtu");
  if (job.vtu && job.vtu->extension() != ".vtu")
    throw UsageError(job.vtu->string() + ": expected a name ending in .vtu");
  job.fields = CarriedFields(arguments, job.output);
  job.parameters = arguments.text("-f");
  job.geometry = arguments.text("-geometry");
  if (job.geometry && !arguments.has("-hausd"))
    throw UsageError(
        "option -geometry: expected -hausd, which says how far from it boundaries may "
        "be, found none");
  set_sizes(job, arguments);
}

/// A factor; 0 for none, which the command line says by 0 or less, as in Mmg.
double gradation_of(const Arguments& arguments, std::string_view option) {
  const double factor = arguments.number(option).value_or(0);
  if (factor > 0 && factor < 1)
    throw UsageError("option " + std::string(option) +
                     ": expected a factor of 1 or more, or -1 for none, found '" +
                     *arguments.text(option) + "'");
  return std::max(factor, 0.0);
}

void set_options(AdaptOptions& adapt, const Arguments& arguments) {
  adapt.smallest_size = size_option(arguments, "-hmin").value_or(0);
  adapt.largest_size = size_option(arguments, "-hmax").value_or(0);
  if (adapt.largest_size > 0 && adapt.smallest_size > adapt.largest_size)
    throw UsageError("options -hmin and -hmax: expected -hmin to be the smaller one");
  adapt.gradation = gradation_of(arguments, "-hgrad");
  adapt.curved_sizes = arguments.has("-A");
  if (adapt.gradation == 0 && arguments.has("-hgrad")) adapt.gradation = -1;
  if (!arguments.has("-nosizreq")) adapt.required_gradation = gradation_of(arguments, "-hgradreq");
  adapt.thorough = arguments.has("--thorough");
  adapt.by_colours = arguments.has("--by-colours");
  adapt.move = !arguments.has("-nomove");
  adapt.swap = !arguments.has("-noswap");
  adapt.insert = !arguments.has("-noinsert");
  adapt.make.lock_boundary = arguments.has("-nosurf");
  adapt.make.hausdorff_tolerance = size_option(arguments, "-hausd").value_or(0);
  adapt.make.ridge_angle = arguments.positive("-ar").value_or(adapt.make.ridge_angle);
  if (adapt.make.ridge_angle >= 90)
    throw UsageError("option -ar: expected an angle of less than 90 degrees, found '" +
                     *arguments.text("-ar") + "'");
  if (arguments.has("-nr")) adapt.make.ridge_angle = std::nextafter(90.0, 0.0);
  adapt.make.complete_boundary = arguments.has("--complete-boundary");
  if (const auto n = arguments.integer("--iterations", 1, 1000)) adapt.iterations = *n;
}

std::vector<fs::path> outputs_of(const Job& job) {
  std::vector<fs::path> paths = {place_of(job.output)};
  if (job.metric_out) paths.push_back(*job.metric_out);
  paths.insert(paths.end(), job.fields.outputs().begin(), job.fields.outputs().end());
  if (job.vtu) paths.push_back(*job.vtu);
  if (job.json && *job.json != standard_output) paths.push_back(*job.json);
  return paths;
}

/// Throws UsageError if an output would replace an input. A mesh may be adapted in place, with its
/// metric.
void expect_inputs_to_stay(const Job& job) {
  std::vector<fs::path> inputs = {job.input}, fields = job.fields.inputs();
  if (job.metric_in) fields.push_back(*job.metric_in);
  if (job.level_set && job.level_set->values) fields.emplace_back(*job.level_set->values);
  for (const auto& path : {job.parameters, job.geometry})
    if (path) fields.push_back(*path);
  for (const fs::path& path : job.places.inputs()) fields.push_back(path);
  inputs.insert(inputs.end(), fields.begin(), fields.end());
  for (const auto& path : {job.json, job.vtu})
    if (path) expect_no_input(*path, inputs);
  std::error_code ignored;
  if (fs::equivalent(job.output, job.input, ignored)) return;
  expect_no_input(job.output, fields);
  if (job.metric_out) expect_no_input(*job.metric_out, fields);
  for (const fs::path& path : job.fields.outputs()) expect_no_input(path, fields);
}

}  // namespace

AdaptJob adapt_job(const Arguments& arguments, const std::optional<fs::path>& output) {
  Job job;
  set_files(job, arguments, output);
  set_options(job.adapt, arguments);
  job.verbosity = arguments.integer("-v", -1, 10).value_or(1);
  job.threads = arguments.integer("--threads", 1, 4096).value_or(0);
  job.racing = arguments.has("--racing");
  if (const auto megabytes = arguments.integer("-m", 1, 1 << 30))
    job.memory = static_cast<std::size_t>(*megabytes) << 20U;
  job.unneeded = unneeded_mmg_options(arguments);
  return job;
}

void check_files(AdaptJob& job) {
  if (job.metric_found) job.metric_in = metric_beside(job.input);
  job.metric_found = job.metric_found && job.metric_in;
  if (job.level_set && !job.level_set->values)
    if (const auto beside = metric_beside(job.input)) job.level_set->values = beside->string();
  expect_inputs_to_stay(job);
  meshadapt::check_writable(outputs_of(job));
}

std::size_t memory_left(std::optional<std::size_t> given) {
  const std::size_t most = given ? *given : runtime::most_memory(), held = runtime::held_memory();
  return most == 0 ? 0 : most - std::min(held, most - 1);
}

namespace {

/// One line on standard error, rewritten in place; gone when the work is done.
class ProgressLine {
 public:
  explicit ProgressLine(bool shown) : shown_(shown) {}
  ~ProgressLine() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const meshadapt::AdaptProgress& progress) const {
    if (!shown_) return;
    std::fprintf(stderr, "\r\033[Kiteration %d: %s, %s changes", progress.iteration, progress.step,
                 with_commas(progress.changes).c_str());
    std::fflush(stderr);
  }

 private:
  bool shown_;
};

AdaptedMesh adapt_with_progress(const Executor& executor, const Job& job, const AnyMesh& mesh,
                                const AnyField& metric, const meshadapt::Sizes& sizes) {
  const ProgressLine line(job.verbosity > 0 && stderr_is_terminal());
  AdaptOptions adapt = job.adapt;
  adapt.memory_limit = memory_left(job.memory);
  adapt.progress = [&line](const meshadapt::AdaptProgress& progress) {
    line.show(progress);
    return true;
  };
  return !job.places.any() ? meshadapt::adapt(executor, mesh, metric, adapt)
                           : meshadapt::adapt_to_sizes(executor, mesh, sizes, adapt);
}

void expect_right(const meshadapt::AdjacentMesh& before, const meshadapt::AdjacentMesh& after,
                  double hausdorff_tolerance) {
  const auto faults = meshadapt::adapted_faults(before, after, hausdorff_tolerance);
  if (!faults.empty())
    throw meshadapt::Error("the adapted mesh is not valid (" + faults.front() +
                           "); nothing was written; please report this with its input");
}

std::string what_was_done(const Job& job, const AdaptInput& input, const AdaptSummary& summary) {
  std::string text = input.cut ? to_text(*input.cut) : std::string(), written;
  text += to_text(summary, job.verbosity > 1);
  for (const fs::path& path : outputs_of(job))
    written += (written.empty() ? "written: " : ", ") + path.string();
  return text + meshadapt::printable(written) + "\n";
}

bool is_level_set(const Job& job, const meshadapt::NamedField& field) {
  return job.level_set && job.level_set->values.value_or(field.name) == field.name;
}

void warn_of_fields_left(const Job& job, const meshadapt::MeshWithFields& file,
                         meshadapt::Warnings& warnings) {
  std::string names;
  for (const meshadapt::NamedField& field : file.fields)
    if (field.name != "metric" && !is_level_set(job, field))
      names += (names.empty() ? "" : ", ") + field.name;
  if (!names.empty() && job.fields.inputs().empty())
    warnings.push_back(
        file.mesh.name + ": its fields are not carried: " + names +
        "; --field takes those at the vertices of a file along, ductile transfer all");
}

}  // namespace

/// Prints warnings, and takes the last memory, before files get their names.
void write_outputs(const Job& job, const AdaptOutput& output, meshadapt::Warnings& warnings) {
  meshadapt::AtomicOutputs outputs;
  std::vector<meshadapt::NamedField> fields;
  if (job.with_metric) fields = meshadapt::named_fields(output.metric, "metric");
  fields.insert(fields.end(), output.fields.begin(), output.fields.end());
  meshadapt::WriteOptions as_named;
  if (holds_fields(job.output)) as_named.fields = fields;
  as_named.warnings = &warnings;
  const std::string ending = job.output.extension().string();
  as_named.format = ending;
  meshadapt::write_mesh(outputs, place_of(job.output), output.mesh, as_named);
  if (job.metric_out) meshadapt::write_field(outputs, *job.metric_out, output.metric);
  job.fields.write(outputs, output.mesh, output.fields, output.field_count_of);
  if (job.vtu) meshadapt::write_mesh(outputs, *job.vtu, output.mesh, {.fields = fields});
  print_warnings(warnings, job.verbosity);
  if (job.json) put_json(outputs, *job.json, output.json);
  outputs.commit();
}

namespace {

int work(const Executor& executor, Job job) {
  if (job.memory) limit_memory(*job.memory);  // which OpenMP must have its threads before
  meshadapt::Warnings warnings;
  const AdaptInput input = read_input(executor, job, warnings);
  const AnyMesh& mesh = input.file.mesh;
  warn_of_fields_left(job, input.file, warnings);
  job.adapt.make.geometry = read_geometry(executor, job, warnings);

  AdaptedMesh adapted = adapt_with_progress(executor, job, mesh, input.metric, input.sizes);
  const meshadapt::AdjacentMesh before(executor, mesh), after(executor, adapted.mesh);
  if (!adapted.report.checked) expect_right(before, after, job.adapt.make.hausdorff_tolerance);
  adapted.mesh.name = job.output.string();
  const auto carried =
      job.fields.carry(executor, input.mesh_of_fields(), input.fields, adapted.mesh);
  const AdaptSummary summary = summarise(
      before, input.metric, adapted, after,
      {.before = job.json || job.verbosity > 1,
       .after = job.json || job.verbosity > 0,
       .expects_lengths = job.adapt.insert,
       .keeps_surface = job.adapt.make.hausdorff_tolerance == 0 && !job.adapt.make.lock_boundary,
       .hausdorff_tolerance = job.adapt.make.lock_boundary ? 0 : job.adapt.make.hausdorff_tolerance,
       .in_force = input.in_force});
  warnings.insert(warnings.end(), summary.report.warnings.begin(), summary.report.warnings.end());
  const std::string said = job.verbosity > 0 ? what_was_done(job, input, summary) : std::string();
  write_outputs(
      job,
      {adapted.mesh, adapted.metric, carried, input.fields.count_of,
       job.json ? to_json(summary, input.cut ? to_json(*input.cut) : "null") : std::string()},
      warnings);
  // From here on no memory is taken, because the outputs are there.
  const bool taken = is_standard_output(job.output) || job.json == standard_output;
  std::fputs(said.c_str(), taken ? stderr : stdout);
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
    "The metric is a size or a tensor at each vertex; edges get a length of about one in it.\n"
    "Without any, the sizes that the mesh has are kept, stretched as they are. Sizes by places "
    "are\n"
    "evaluated on the adapted mesh, too, which is adapted again while it lacks some, at most five\n"
    "times in all. A level set is cut out first; references are 3 below V, 2 above and 10 "
    "between,\n"
    "and with -hausd the interface is adapted to its curved surface. The metric at the new "
    "vertices is written beside the adapted mesh. Old output\n"
    "files stay as they are until the new ones are complete.",
    options,
    run};

}  // namespace ductile::cli
