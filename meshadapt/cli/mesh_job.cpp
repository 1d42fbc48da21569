#include "mesh_job.hpp"

#include <algorithm>
#include <utility>

#include "command.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "files.hpp"
#include "size_options.hpp"

namespace ductile::cli {

// ---- Fields ----

CarriedFields::CarriedFields(const Arguments& arguments, const fs::path& output)
    : interpolate_(arguments.has("--interpolate")) {
  for (const std::string& name : arguments.texts("--field")) inputs_.emplace_back(name);
  if (holds_fields(output)) return;  // which they then go into
  const std::string ending = field_beside(output).extension().string();
  for (const fs::path& input : inputs_) {
    const fs::path place =
        field_beside(output).replace_extension("." + input.stem().string() + ending);
    const auto same = std::find(outputs_.begin(), outputs_.end(), place);
    if (same != outputs_.end())
      throw UsageError("options --field: " +
                       inputs_[static_cast<std::size_t>(same - outputs_.begin())].string() +
                       " and " + input.string() + " would both be written to " + place.string() +
                       "; give one of them another name");
    outputs_.push_back(place);
  }
}

/// A name that is taken gets that of the file in front.
CarriedFields::Values CarriedFields::read(const AnyMesh& mesh, Warnings& warnings) const {
  Values values;
  const auto is_taken = [&](const std::string& name) {
    return name == "metric" ||
           std::ranges::find(values.fields, name, &NamedField::name) != values.fields.end();
  };
  for (const fs::path& input : inputs_) {
    auto fields = read_solutions(input, mesh, warnings);
    values.count_of.push_back(fields.size());
    for (NamedField& field : fields) {
      while (is_taken(field.name)) field.name.insert(0, as_utf8(input.stem().string()) + "_");
      values.fields.push_back(std::move(field));
    }
  }
  return values;
}

std::vector<NamedField> CarriedFields::carry(const runtime::Executor& executor, const AnyMesh& from,
                                             const Values& values, const AnyMesh& to) const {
  if (inputs_.empty()) return {};
  const bool by_value = interpolate_ || is_surface(from);
  const Carrying way = by_value ? Carrying::by_value : Carrying::conservatively;
  return transfer_fields(executor, {from, values.fields}, to, {way}).fields;
}

void CarriedFields::write(AtomicOutputs& outputs, const AnyMesh& mesh,
                          const std::vector<NamedField>& carried,
                          const std::vector<std::size_t>& count_of) const {
  auto next = carried.begin();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto first = std::exchange(next, next + static_cast<std::ptrdiff_t>(count_of[i]));
    write_field(outputs, outputs_[i], side_by_side({first, next}, mesh));
  }
}

// ---- The job ----

void set_job(MeshJob& job, const Arguments& arguments, const std::optional<fs::path>& output) {
  const auto out = arguments.text("-o");
  if (!output && !out && job.input == "/dev/stdin")
    throw UsageError("expected -o, because the mesh is read from standard input, found none");
  job.output = output ? *output : out ? output_of(*out) : default_output(job.input);
  expect_mesh_name(job.output);
  const bool to_standard = is_standard_output(job.output), holds = holds_fields(job.output);
  if (to_standard && !holds && arguments.has("--field"))
    throw UsageError(
        "option --field: expected an output beside which fields can be, or -.vtu, found " +
        job.output.string());
  job.with_metric = !arguments.has("--no-metric");
  if (job.with_metric && !to_standard && !holds) job.metric_out = field_beside(job.output);
  job.json = arguments.text("--json");
  if (job.json == standard_output && to_standard)
    throw UsageError("option --json: expected a file, because the mesh goes to standard output");
  job.fields = CarriedFields(arguments, job.output);
  job.size = size_option(arguments, "-hsiz");
  job.verbosity = verbosity_of(arguments);
  job.threads = threads_of(arguments);
}

std::vector<fs::path> outputs_of(const MeshJob& job) {
  std::vector<fs::path> paths = {place_of(job.output)};
  if (job.metric_out) paths.push_back(*job.metric_out);
  paths.insert(paths.end(), job.fields.outputs().begin(), job.fields.outputs().end());
  if (job.vtu) paths.push_back(*job.vtu);
  if (job.json && *job.json != standard_output) paths.push_back(*job.json);
  return paths;
}

std::string written(const MeshJob& job) { return printable("written: " + listed(outputs_of(job))); }

std::FILE* messages_of(const MeshJob& job) {
  return is_standard_output(job.output) || job.json == standard_output ? stderr : stdout;
}

/// Prints warnings, and takes the last memory, before files get their names.
void write_outputs(const MeshJob& job, const MeshOutput& output, Warnings& warnings) {
  AtomicOutputs outputs;
  std::vector<NamedField> fields;
  if (job.with_metric) fields = named_fields(output.metric, "metric");
  fields.insert(fields.end(), output.fields.begin(), output.fields.end());
  WriteOptions as_named;
  if (holds_fields(job.output)) as_named.fields = fields;
  as_named.warnings = &warnings;
  const std::string ending = job.output.extension().string();
  as_named.format = ending;
  write_mesh(outputs, place_of(job.output), output.mesh, as_named);
  if (job.metric_out) write_field(outputs, *job.metric_out, output.metric);
  job.fields.write(outputs, output.mesh, output.fields, output.field_count_of);
  if (job.vtu) write_mesh(outputs, *job.vtu, output.mesh, {.fields = fields});
  const std::string json = job.json ? output.json().text : std::string();
  print_warnings(warnings, job.verbosity);
  if (job.json) put_json(outputs, *job.json, json);
  outputs.commit();
}

}  // namespace ductile::cli
