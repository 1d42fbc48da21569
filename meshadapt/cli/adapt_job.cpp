/// @file
/// Reads the command line of `adapt` into an AdaptJob.
#include "adapt_job.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "files.hpp"
#include "mmg_options.hpp"
#include "recovery_option.hpp"
#include "size_options.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::AdaptOptions;
using Job = AdaptJob;

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
  job.input = only_mesh(arguments, "; -o says where the adapted one goes");
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

}  // namespace

std::vector<fs::path> outputs_of(const AdaptJob& job) {
  std::vector<fs::path> paths = {place_of(job.output)};
  if (job.metric_out) paths.push_back(*job.metric_out);
  paths.insert(paths.end(), job.fields.outputs().begin(), job.fields.outputs().end());
  if (job.vtu) paths.push_back(*job.vtu);
  if (job.json && *job.json != standard_output) paths.push_back(*job.json);
  return paths;
}

namespace {

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

}  // namespace ductile::cli
