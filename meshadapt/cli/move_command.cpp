#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "adapt_report.hpp"
#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/move.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/process.hpp"
#include "files.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh_job.hpp"
#include "size_options.hpp"

namespace ductile::cli {

namespace {

using runtime::Executor;

constexpr std::array<Option, 18> options{{
    {"-o", "OUT", "where the moved mesh goes (default: NAME.o.mesh, or as the input is)", "--out"},
    {"--bodies", "REF,...", "moves the elements with these references, as DISPLACEMENT says"},
    {"--boundaries", "REF,...", "moves the edges (3D: triangles) with these references, likewise"},
    {"-met", "METRIC",
     "the metric to adapt to; it goes along (default: that in MESH, or else the sizes of MESH)"},
    {"-hsiz", "X", "adapts to edges of length X everywhere"},
    {"-hmin", "X", "asks for no edge shorter than X"},
    {"-hmax", "X", "asks for no edge longer than X"},
    {"-hgrad", "X", "lets sizes grow by a factor of X at most per unit length (default: no limit)"},
    {"--remesh-below", "Q", "adapts where quality falls below Q (default: 0.35, 3D: 0.2)"},
    {"--keep-partial", "", "if the way is blocked, writes the mesh of the place that was reached"},
    {"--field", "FIELD", "carries fields of a file, too, to OUT.FIELD.sol; may be given again"},
    {"--interpolate", "", "carries fields by their values, whatever becomes of integrals"},
    {"--turn", "NAME", "turns this field of vectors or tensors with the mesh; may be given again"},
    {"--complete-boundary", "", "gives boundary facets missing in the file reference 0"},
    {"--no-metric", "", "writes no metric beside the moved mesh"},
    {"--json", "FILE", "writes counts, times and quality there, a .json, or - for output"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
    {"-v", "N", "0 says nothing, 1 (default) sums up", "--verbose"},
}};

/// The command line of `move`, or of `adapt -lag`.
struct MoveJob : MeshJob {
  std::string displacement;  // a file, or a field of the mesh's file
  MoveOptions move;          // without the metric and fields
};

// ---- The command line ----

std::vector<std::int32_t> references(const Arguments& arguments, const char* option) {
  std::vector<std::int32_t> list;
  if (const auto text = arguments.text(option))
    for (const std::string& word : split(*text, ','))
      list.push_back(whole_number(option, word, -2147483647, 2147483647));
  return list;
}

/// Sets the options that `move` and `adapt -lag` share.
void set_common(MoveJob& job, const Arguments& arguments) {
  set_job(job, arguments);
  const SizeBounds bounds = size_bounds(arguments);
  job.move.smallest_size = bounds.smallest;
  job.move.largest_size = bounds.largest;
  job.move.gradation = gradation_of(arguments, "-hgrad");
  job.move.complete_boundary = arguments.has("--complete-boundary");
}

MoveJob move_job(const Arguments& arguments) {
  MoveJob job;
  const auto& words = arguments.operands();
  if (words.size() != 2)
    throw UsageError("expected a mesh and a displacement, found " + std::to_string(words.size()) +
                     (words.size() == 1 ? " word" : " words"));
  job.input = input_of(words[0]);
  job.displacement = words[1];
  set_common(job, arguments);
  job.metric_in = arguments.text("-met");
  if (job.metric_in && job.size)
    throw UsageError("options -met and -hsiz: expected one of them, found both");
  job.move.bodies = references(arguments, "--bodies");
  job.move.boundaries = references(arguments, "--boundaries");
  job.move.turned = arguments.texts("--turn");
  job.move.remesh_below = arguments.positive("--remesh-below").value_or(0);
  job.move.keep_partial = arguments.has("--keep-partial");
  return job;
}

void check_files(const MoveJob& job) {
  std::vector<fs::path> inputs = job.fields.inputs();
  inputs.push_back(job.input);
  if (is_file(job.displacement)) inputs.emplace_back(job.displacement);
  if (job.metric_in) inputs.push_back(*job.metric_in);
  for (const fs::path& output : outputs_of(job)) expect_no_input(output, inputs);
  check_writable(outputs_of(job));
}

// ---- The work ----

AnyField displacement_of(const MoveJob& job, const MeshWithFields& file, Warnings& warnings) {
  const std::vector<NamedField> found = chosen_solutions({job.displacement}, file, warnings);
  AnyField field = side_by_side(found, file.mesh);
  field.name = job.displacement;
  return field;
}

AnyField metric_of(const MoveJob& job, const MeshWithFields& file, Warnings& warnings) {
  const SizeBounds bounds{job.move.smallest_size, job.move.largest_size};
  if (job.size) return constant_metric(file.mesh, *job.size);
  if (job.metric_in) return read_metric(*job.metric_in, file.mesh, warnings, bounds);
  if (const auto own = metric_in(file)) return metric_of(*own, file.mesh, bounds);
  return implied_metric(file.mesh);
}

/// The fields that go along: `given` ones, and those of the mesh's own file if the output can hold
/// them, without the displacement and the metric. Otherwise a warning names these.
std::vector<NamedField> fields_along(const MoveJob& job, const MeshWithFields& file,
                                     std::vector<NamedField> given, Warnings& warnings) {
  std::vector<NamedField> own;
  for (const NamedField& field : file.fields)
    if (field.name != "metric" && field.name != job.displacement &&
        std::ranges::find(given, field.name, &NamedField::name) == given.end())
      own.push_back(field);
  if (!own.empty() && !holds_fields(job.output))
    warnings.push_back(file.mesh.name + ": its fields are not carried: " + names_of(own) +
                       "; a .vtu, .vtk or .msh as output would hold them");
  else
    given.insert(given.end(), own.begin(), own.end());
  return given;
}

/// Marks on elements go by value, and so do fields without an integral; all others keep it.
Carrying carrying(const MoveJob& job, const NamedField& field) {
  const bool is_finite =
      std::ranges::all_of(field.values, [](double x) { return std::isfinite(x); });
  return job.fields.interpolates() || !is_finite || (field.whole && !is_at_vertices(field))
             ? Carrying::by_value
             : Carrying::conservatively;
}

std::string summary(const MoveJob& job, const MovedMesh& moved) {
  const MoveReport& report = moved.report;
  return format(
             "moved %.6g %% of the way in %d steps; %d adaptations of parts, %s elements in all\n"
             "%s elements, worst quality %.3g\n%.2f s, %.2f s of them adapting\n",
             100 * report.share, report.steps, report.adaptations,
             with_commas(report.adapted_elements).c_str(),
             with_commas(element_count(moved.mesh)).c_str(), report.worst_quality,
             report.total_seconds, report.adapt_seconds) +
         written(job) + "\n";
}

/// The meshes and metrics before and after.
struct Run {
  const AnyMesh& before;
  const AnyField& metric;
  const MovedMesh& moved;
};

Json to_json(const Executor& executor, const Run& run, const Warnings& warnings) {
  const MoveReport& report = run.moved.report;
  const auto measured = [&](const AnyMesh& mesh, const AnyField& metric) {
    return to_json(MeasuredMesh{mesh, measure(executor, mesh, &metric)});
  };
  return json_lines(
      {json_object("before", measured(run.before, run.metric)),
       json_object("after", measured(run.moved.mesh, run.moved.metric)),
       json_object("share", report.share, "stopped",
                   report.stopped.empty() ? Json() : Json(report.stopped), "steps", report.steps,
                   "adaptations", report.adaptations, "adapted_elements", report.adapted_elements,
                   "worst_quality", report.worst_quality),
       json_object("threads", executor.threads(), "seconds",
                   json_object("total", report.total_seconds, "adapting", report.adapt_seconds)),
       json_object("peak_memory_bytes", runtime::peak_memory()),
       json_object("warnings", json_list({warnings.begin(), warnings.end()}))});
}

int work(const Executor& executor, MoveJob job) {
  Warnings warnings;
  const MeshWithFields file = read_mesh_with_fields(job.input, &warnings);
  const CarriedFields::Values given = job.fields.read(file.mesh, warnings);
  const std::vector<NamedField> fields = fields_along(job, file, given.fields, warnings);
  const AnyField displacement = displacement_of(job, file, warnings);
  const AnyField metric = metric_of(job, file, warnings);
  job.move.metric = &metric;
  job.move.fields = fields;
  job.move.carrying.clear();
  for (const NamedField& field : fields) job.move.carrying.push_back(carrying(job, field));
  MovedMesh moved = move(executor, file.mesh, displacement, job.move);
  moved.mesh.name = job.output.string();
  warnings.insert(warnings.end(), moved.report.warnings.begin(), moved.report.warnings.end());
  if (!moved.report.stopped.empty())
    warnings.push_back("the way was not gone to its end, " + moved.report.stopped);
  const std::string said = job.verbosity > 0 ? summary(job, moved) : std::string();
  write_outputs(job,
                {moved.mesh, moved.metric, moved.fields, given.count_of,
                 [&] {
                   return to_json(executor, {file.mesh, metric, moved}, warnings);
                 }},
                warnings);
  // From here on no memory is taken, because the outputs are there.
  std::fputs(said.c_str(), messages_of(job));
  return moved.report.stopped.empty() ? done : failed;
}

int run_job(const MoveJob& job) {
  check_files(job);
  return run_in_team({.threads = job.threads},
                     [&](const Executor& executor) { return work(executor, job); });
}

int run(const Arguments& arguments) { return run_job(move_job(arguments)); }

}  // namespace

int run_lag(const Arguments& arguments) {
  for (const char* option :
       {"--solution", "--elements",   "--recovery", "--near",       "--on",     "--inside",
        "-f",         "-nomove",      "-noswap",    "-noinsert",    "-hausd",   "-geometry",
        "-A",         "--iterations", "--thorough", "--by-colours", "--racing", "--vtu",
        "--join",     "-ls",          "-lssurf",    "-rmc",         "-isoref",  "--keep-volume"})
    if (arguments.has(option))
      throw UsageError(std::string("options -lag and ") + option +
                       ": expected one of them, found both");
  MoveJob job;
  job.input = only_mesh(arguments);
  const auto displacement = arguments.text("-sol");
  job.displacement = displacement ? *displacement : field_beside(job.input).string();
  set_common(job, arguments);
  const auto lag = arguments.integer("-lag", 0, 2);
  job.move.remeshes = lag != 0;
  job.move.insert = lag == 2;
  return run_job(job);
}

const Command move_command{
    "move",
    "MESH DISPLACEMENT [-o OUT]",
    "moves bodies of a mesh, and adapts it near them where it must",
    "DISPLACEMENT is a file with a vector at each vertex, or a field of MESH. Bodies that it "
    "moves\n"
    "rigidly turn on their way, others go straight; the mesh around them follows. Without "
    "--bodies\n"
    "and --boundaries all vertices move whose displacement is not zero, and regions with such\n"
    "vertices inside. Where the way is blocked nothing is written, see --keep-partial. All fields\n"
    "of MESH go along if OUT can hold them: with their integrals, marks on elements by value. The\n"
    "metric at the vertices is written beside the moved mesh: give it to the next call with -met.",
    options,
    run};

}  // namespace ductile::cli
