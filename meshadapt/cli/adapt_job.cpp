/// @file
/// Reads the command line of `adapt` into an AdaptJob.
#include "adapt_job.hpp"

#include <algorithm>
#include <cmath>

#include "files.hpp"
#include "mmg_options.hpp"

namespace ductile::cli {

namespace {

using Job = AdaptJob;

/// Sizes are given in at most one way; otherwise a metric beside the mesh is used, if there is one.
void set_sizes(Job& job, const Arguments& arguments) {
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
  set_job(job, arguments, output);
  job.join = join_option(arguments);
  job.vtu = arguments.text("--vtu");
  if (job.vtu && job.vtu->extension() != ".vtu")
    throw UsageError(job.vtu->string() + ": expected a name ending in .vtu");
  if (job.fields.interpolates() && job.fields.inputs().empty())
    throw UsageError("option --interpolate: expected --field as well");
  job.parameters = arguments.text("-f");
  job.geometry = arguments.text("-geometry");
  if (job.geometry && !arguments.has("-hausd"))
    throw UsageError(
        "option -geometry: expected -hausd, which says how far from it boundaries may "
        "be, found none");
  set_sizes(job, arguments);
}

void set_options(AdaptOptions& adapt, const Arguments& arguments) {
  const SizeBounds bounds = size_bounds(arguments);
  adapt.smallest_size = bounds.smallest;
  adapt.largest_size = bounds.largest;
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
  check_writable(outputs_of(job));
}

}  // namespace ductile::cli
