#include "move_command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "adapt_report.hpp"
#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "ductile/runtime/process.hpp"
#include "files.hpp"
#include "report.hpp"
#include "run_in_team.hpp"
#include "size_options.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::NamedField;
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

// ---- The command line ----

std::vector<std::int32_t> references(const Arguments& arguments, const char* option) {
  std::vector<std::int32_t> list;
  std::string text = arguments.text(option).value_or("");
  while (!text.empty()) {
    const std::size_t end = text.find(',');
    list.push_back(whole_number(option, text.substr(0, end), -2147483647, 2147483647));
    text = end == std::string::npos ? "" : text.substr(end + 1);
  }
  return list;
}

/// Sets the options that `move` and `adapt -lag` share.
void set_common(MoveJob& job, const Arguments& arguments) {
  const auto out = arguments.text("-o");
  if (!out && job.input == "/dev/stdin")
    throw UsageError("expected -o, because the mesh is read from standard input, found none");
  job.output = out ? output_of(*out) : default_output(job.input);
  expect_mesh_name(job.output);
  job.fields = CarriedFields(arguments, job.output);
  if (!arguments.has("--no-metric") && !holds_fields(job.output) && !is_standard_output(job.output))
    job.metric_out = field_beside(job.output);
  job.json = json_output(arguments);
  if (job.json == standard_output && is_standard_output(job.output))
    throw UsageError("option --json: expected a file, because the mesh goes to standard output");
  job.size = size_option(arguments, "-hsiz");
  job.move.smallest_size = size_option(arguments, "-hmin").value_or(0);
  job.move.largest_size = size_option(arguments, "-hmax").value_or(0);
  job.move.gradation = std::max(0.0, arguments.number("-hgrad").value_or(0));
  job.move.complete_boundary = arguments.has("--complete-boundary");
  job.threads = arguments.integer("--threads", 1, 4096).value_or(0);
  job.verbosity = arguments.integer("-v", -1, 10).value_or(1);
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

std::vector<fs::path> outputs_of(const MoveJob& job) {
  std::vector<fs::path> paths{place_of(job.output)};
  if (job.metric_out) paths.push_back(*job.metric_out);
  if (job.json && *job.json != standard_output) paths.push_back(*job.json);
  paths.insert(paths.end(), job.fields.outputs().begin(), job.fields.outputs().end());
  return paths;
}

void check_files(const MoveJob& job) {
  std::vector<fs::path> inputs = job.fields.inputs();
  inputs.push_back(job.input);
  if (is_file(job.displacement)) inputs.emplace_back(job.displacement);
  if (job.metric_in) inputs.push_back(*job.metric_in);
  for (const fs::path& output : outputs_of(job)) expect_no_input(output, inputs);
  meshadapt::check_writable(outputs_of(job));
}

// ---- The work ----

AnyField displacement_of(const MoveJob& job, const meshadapt::MeshWithFields& file,
                         meshadapt::Warnings& warnings) {
  const std::vector<NamedField> found = chosen_solutions({job.displacement}, file, warnings);
  AnyField field = side_by_side(found, file.mesh);
  field.name = job.displacement;
  return field;
}

AnyField metric_of(const MoveJob& job, const meshadapt::MeshWithFields& file,
                   meshadapt::Warnings& warnings) {
  const meshadapt::SizeBounds bounds{job.move.smallest_size, job.move.largest_size};
  if (job.size) return meshadapt::constant_metric(file.mesh, *job.size);
  if (job.metric_in) return read_metric(*job.metric_in, file.mesh, warnings, bounds);
  if (const auto own = metric_in(file)) return meshadapt::metric_of(*own, file.mesh, bounds);
  return meshadapt::implied_metric(file.mesh);
}

/// The fields that go along: `given` ones, and those of the mesh's own file if the output can hold
/// them, without the displacement and the metric. Otherwise a warning names these.
std::vector<NamedField> fields_along(const MoveJob& job, const meshadapt::MeshWithFields& file,
                                     std::vector<NamedField> given, meshadapt::Warnings& warnings) {
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
meshadapt::Carrying carrying(const MoveJob& job, const NamedField& field) {
  const bool is_finite =
      std::ranges::all_of(field.values, [](double x) { return std::isfinite(x); });
  return job.fields.interpolates() || !is_finite || (field.whole && !is_at_vertices(field))
             ? meshadapt::Carrying::by_value
             : meshadapt::Carrying::conservatively;
}

std::string summary(const MoveJob& job, const meshadapt::MovedMesh& moved) {
  const meshadapt::MoveReport& report = moved.report;
  const std::size_t elements =
      moved.mesh.dimension == 2 ? moved.mesh.triangles.size() : moved.mesh.tetrahedra.size();
  char text[400];
  std::snprintf(
      text, sizeof text,
      "moved %.6g %% of the way in %d steps; %d adaptations of parts, %s elements in all\n"
      "%s elements, worst quality %.3g\n%.2f s, %.2f s of them adapting\n",
      100 * report.share, report.steps, report.adaptations,
      with_commas(report.adapted_elements).c_str(), with_commas(elements).c_str(),
      report.worst_quality, report.total_seconds, report.adapt_seconds);
  std::string written;
  for (const fs::path& path : outputs_of(job))
    written += (written.empty() ? "written: " : ", ") + path.string();
  return text + meshadapt::printable(written) + "\n";
}

/// The meshes and metrics before and after.
struct Run {
  const AnyMesh& before;
  const AnyField& metric;
  const meshadapt::MovedMesh& moved;
};

std::string to_json(const Executor& executor, const Run& run, const meshadapt::Warnings& warnings) {
  MeshSummary before = summarise_mesh(run.before), after = summarise_mesh(run.moved.mesh);
  before.statistics = meshadapt::measure(executor, run.before, &run.metric);
  after.statistics = meshadapt::measure(executor, run.moved.mesh, &run.moved.metric);
  const meshadapt::MoveReport& report = run.moved.report;
  std::string list;
  for (const std::string& warning : warnings)
    list += (list.empty() ? "" : ", ") + json_string(warning);
  return "{\"before\": " + to_json(before) + ",\n \"after\": " + to_json(after) +
         ",\n \"share\": " + json_number(report.share) +
         ", \"stopped\": " + (report.stopped.empty() ? "null" : json_string(report.stopped)) +
         ", \"steps\": " + std::to_string(report.steps) +
         ", \"adaptations\": " + std::to_string(report.adaptations) +
         ", \"adapted_elements\": " + std::to_string(report.adapted_elements) +
         ", \"worst_quality\": " + json_number(report.worst_quality) +
         ",\n \"threads\": " + std::to_string(executor.threads()) +
         ", \"seconds\": {\"total\": " + json_number(report.total_seconds) +
         ", \"adapting\": " + json_number(report.adapt_seconds) +
         "},\n \"peak_memory_bytes\": " + std::to_string(runtime::peak_memory()) +
         ",\n \"warnings\": [" + list + "]}\n";
}

/// Writes the outputs, which appear on commit(), except the JSON.
void stage(meshadapt::AtomicOutputs& outputs, const MoveJob& job, const meshadapt::MovedMesh& moved,
           const std::vector<std::size_t>& field_count_of, meshadapt::Warnings& warnings) {
  std::vector<NamedField> all = meshadapt::named_fields(moved.metric, "metric");
  all.insert(all.end(), moved.fields.begin(), moved.fields.end());
  meshadapt::WriteOptions as_named;
  if (holds_fields(job.output)) as_named.fields = all;
  const std::string ending = job.output.extension().string();
  as_named.format = ending;
  as_named.warnings = &warnings;
  meshadapt::write_mesh(outputs, place_of(job.output), moved.mesh, as_named);
  if (job.metric_out) meshadapt::write_field(outputs, *job.metric_out, moved.metric);
  job.fields.write(outputs, moved.mesh, moved.fields, field_count_of);
}

int work(const Executor& executor, MoveJob job) {
  meshadapt::Warnings warnings;
  const meshadapt::MeshWithFields file = meshadapt::read_mesh_with_fields(job.input, &warnings);
  const CarriedFields::Values given = job.fields.read(file.mesh, warnings);
  const std::vector<NamedField> fields = fields_along(job, file, given.fields, warnings);
  const AnyField displacement = displacement_of(job, file, warnings);
  const AnyField metric = metric_of(job, file, warnings);
  job.move.metric = &metric;
  job.move.fields = fields;
  job.move.carrying.clear();
  for (const NamedField& field : fields) job.move.carrying.push_back(carrying(job, field));
  meshadapt::MovedMesh moved = meshadapt::move(executor, file.mesh, displacement, job.move);
  moved.mesh.name = job.output.string();
  warnings.insert(warnings.end(), moved.report.warnings.begin(), moved.report.warnings.end());
  if (!moved.report.stopped.empty())
    warnings.push_back("the way was not gone to its end, " + moved.report.stopped);
  const std::string said = job.verbosity > 0 ? summary(job, moved) : std::string();
  meshadapt::AtomicOutputs outputs;
  stage(outputs, job, moved, given.count_of, warnings);
  if (job.json)
    put_json(outputs, *job.json, to_json(executor, {file.mesh, metric, moved}, warnings));
  print_warnings(warnings, job.verbosity);
  outputs.commit();
  // From here on no memory is taken, because the outputs are there.
  const bool taken = is_standard_output(job.output) || job.json == standard_output;
  std::fputs(said.c_str(), taken ? stderr : stdout);
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
