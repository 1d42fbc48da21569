#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "adapt_job.hpp"
#include "adapt_parts.hpp"
#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/process.hpp"
#include "file_part.hpp"
#include "files.hpp"
#include "first_rank.hpp"
#include "local_parameters.hpp"
#include "outputs.hpp"
#include "program.hpp"
#include "system.hpp"
#include "threads.hpp"
#include "transfer_parts.hpp"

namespace ductile::petsc {

namespace {

namespace fs = std::filesystem;
using cli::AdaptJob;
using cli::Arguments;
using cli::Option;
using meshadapt::Carrying;
using meshadapt::NamedField;
using meshadapt::Warnings;
using runtime::Executor;

/// Options of `ductile adapt` that need all of a mesh in one place, or one order of events.
constexpr std::array<std::string_view, 12> not_here{"-hausd",   "-geometry", "-A",    "-ar",
                                                    "-nr",      "--near",    "--on",  "--inside",
                                                    "--racing", "--json",    "--vtu", "-optim"};

enum class Form { gathered, pieces, hdf5 };

/// What files say, in the order in which it is made. Only the form is known on every rank, the
/// rest on the first one.
struct Input {
  AdaptJob job;
  fs::path output;
  Form form = Form::gathered;
  FilePart file;
  std::vector<NamedField> fields;
  std::vector<std::size_t> field_count_of;  // [file given by --field]
  std::vector<meshadapt::ReferenceName> names;
  int dropped_axis = 2;
  Warnings warnings;
};

// ---- The command line ----

std::vector<Option> options_here() {
  std::vector<Option> options;
  for (Option option : cli::adapt_command.options) {
    if (std::find(not_here.begin(), not_here.end(), option.name) != not_here.end()) continue;
    if (option.name == "-o")
      option.help =
          "a mesh, gathered; a .pvtu, in pieces; a .h5, of PETSc's (default: NAME.o.mesh)";
    if (option.name == "--threads") option.help = "threads of each rank (default: its cores)";
    if (option.name == "-m") option.help = "takes at most this much memory on each rank, in MB";
    if (option.name == "--field")
      option.help = "carries fields, too, as those in the input; may be given again";
    options.push_back(option);
  }
  return options;
}

void refuse_what_is_not_here(const Arguments& arguments) {
  for (const std::string_view name : not_here)
    if (arguments.has(name))
      throw cli::UsageError("option " + std::string(name) +
                            ": not on several ranks; use ductile adapt, or, for sizes by places, "
                            "ductile metric first");
}

/// A .pvtu and a .h5 hold fields, as a .vtu does, whose name stands in for theirs.
void read_words(Input& input, const Arguments& arguments) {
  refuse_what_is_not_here(arguments);
  std::optional<fs::path> stand_in;
  if (const auto given = arguments.text("-o")) {
    const fs::path output = *given;
    if (output.extension() == ".pvtu") input.form = Form::pieces;
    if (output.extension() == ".h5" || output.extension() == ".hdf5") input.form = Form::hdf5;
    if (input.form != Form::gathered) stand_in = fs::path(output).replace_extension(".vtu");
    input.output = output;
  }
  input.job = cli::read_adapt_job(arguments, stand_in);
  if (input.form == Form::gathered)
    input.output = input.job.output;
  else
    meshadapt::check_writable(input.output);
}

// ---- Reading, on the first rank ----

/// Those in the file of the mesh, where the output holds fields, and those of --field.
void read_fields(Input& input, meshadapt::MeshWithFields& file) {
  const AdaptJob& job = input.job;
  std::string left;
  for (NamedField& field : file.fields) {
    if (field.name == "metric") continue;
    if (cli::holds_fields(job.output))
      input.fields.push_back(std::move(field));
    else
      left += (left.empty() ? "" : ", ") + field.name;
  }
  if (!left.empty())
    input.warnings.push_back(file.mesh.name + ": its fields are left out, which " +
                             job.output.string() + " does not hold: " + left);
  const auto values = job.fields.read(file.mesh, input.warnings);
  input.field_count_of = values.field_count_of;
  if (values.field_count_of.empty()) return;
  std::vector<std::string> names;  // as the files are called
  for (std::size_t f = 0; f < input.field_count_of.size(); ++f)
    for (std::size_t k = 1; k <= input.field_count_of[f]; ++k)
      names.push_back(cli::as_utf8(job.fields.inputs()[f].stem().string()) +
                      (input.field_count_of[f] > 1 ? "_" + std::to_string(k) : ""));
  auto fields = meshadapt::named_fields(values.all, "field");
  for (std::size_t k = 0; k < fields.size(); ++k) {
    fields[k].name = names[k];
    input.fields.push_back(std::move(fields[k]));
  }
}

void read_files(Input& input, const Executor& executor) {
  AdaptJob& job = input.job;
  if (!job.unneeded.empty()) input.warnings.push_back(job.unneeded);
  auto file = meshadapt::read_mesh_with_fields(job.input, &input.warnings);
  if (job.adapt.make.complete_boundary) meshadapt::list_boundary(executor, file.mesh);
  meshadapt::AnyField metric = cli::choose_metric(executor, job, file, {}, input.warnings);
  cli::bound_locally(executor, file.mesh,
                     cli::local_parameters(job.parameters, file.mesh, job.adapt, input.warnings),
                     metric, job.adapt);
  metric =
      meshadapt::metric_of(metric, file.mesh, {job.adapt.smallest_size, job.adapt.largest_size});
  read_fields(input, file);
  input.names = file.mesh.names;
  input.dropped_axis = file.mesh.dropped_axis;
  input.file = part_of_file(std::move(file.mesh), std::move(metric), input.warnings);
}

// ---- What all ranks have to know ----

/// A field, or a name of references, as it goes to other ranks.
struct Told {
  std::array<char, 240> name{};
  int number = 0, other = 0;

  Told() = default;
  Told(const std::string& text, int first, int second) : number(first), other(second) {
    std::copy_n(text.data(), std::min(text.size(), name.size() - 1), name.begin());
  }
};

void tell_others(const Communicator& comm, Input& input) {
  int dimension = input.file.part.mesh.dimension;
  std::array<double, 2> bounds{input.job.adapt.smallest_size, input.job.adapt.largest_size};
  from_first_rank(comm, dimension);
  from_first_rank(comm, bounds);
  from_first_rank(comm, input.form);
  from_first_rank(comm, input.dropped_axis);
  from_first_rank(comm, input.job.with_metric);
  from_first_rank(comm, input.file.kept);
  std::vector<Told> fields, names;
  std::vector<char> output;
  comm.on_all([&] {
    if (comm.rank() != 0) return;
    for (const NamedField& field : input.fields)
      fields.emplace_back(field.name, static_cast<int>(field.type), static_cast<int>(field.place));
    for (const auto& name : input.names)
      names.emplace_back(name.name, name.reference, name.dimension);
    const std::string path = input.output.string();
    output.assign(path.begin(), path.end());
  });
  from_first_rank(comm, fields);
  from_first_rank(comm, names);
  from_first_rank(comm, output);
  input.job.adapt.smallest_size = bounds[0];
  input.job.adapt.largest_size = bounds[1];
  if (comm.rank() == 0) return;
  input.output = std::string(output.begin(), output.end());
  input.file.part = empty_part(dimension);
  for (const Told& field : fields)
    input.fields.push_back({field.name.data(),
                            static_cast<meshadapt::AnyField::Type>(field.number),
                            {},
                            static_cast<NamedField::Place>(field.other)});
  for (const Told& name : names) input.names.push_back({name.other, name.number, name.name.data()});
}

// ---- The work ----

/// Of all ranks together.
void print_costs(const std::array<Costs, phase_count>& costs) {
  constexpr std::array<const char*, phase_count> names{"balance", "migration", "gradation",
                                                       "adaptation"};
  for (std::size_t p = 0; p < phase_count; ++p)
    std::printf("%s%s %.3f s, %.3f MB", p == 0 ? "  processor time and messages: " : "; ", names[p],
                costs[p].seconds, 1e-6 * static_cast<double>(costs[p].bytes));
  std::printf("\n");
}

AdaptPartsOptions options_of(const Communicator& comm, const AdaptJob& job) {
  AdaptPartsOptions options;
  options.adapt = job.adapt;
  options.adapt.make.complete_boundary = false;  // parts list theirs
  if (options.adapt.required_gradation <= 0)
    options.adapt.required_gradation = gradation_at_interfaces;
  options.passes = 6;
  if (job.memory)
    options.adapt.memory_limit = *job.memory - std::min(runtime::held_memory(), *job.memory - 1);
  if (comm.rank() == 0 && job.verbosity > 0)
    options.told = [verbosity = job.verbosity](const PassReport& pass) {
      std::printf(
          "pass %d: %s elements, %lld of %lld edges around interfaces blocked, "
          "imbalance %.2f, %.2f s\n",
          pass.pass, cli::with_commas(static_cast<std::size_t>(pass.elements)).c_str(),
          static_cast<long long>(pass.blocked), static_cast<long long>(pass.edges), pass.imbalance,
          pass.seconds);
      if (verbosity > 1) print_costs(pass.costs);
      std::fflush(stdout);
    };
  return options;
}

AdaptedParts adapted(const Communicator& comm, const Executor& executor, const Part& part,
                     const AdaptPartsOptions& options) {
  return part.mesh.dimension == 2 ? adapt_parts<2>(comm, executor, part, options)
                                  : adapt_parts<3>(comm, executor, part, options);
}

/// The metric, if it is to be written, and the fields that were carried.
std::vector<NamedField> fields_of(const Communicator& comm, const Executor& executor,
                                  const Input& input, const AdaptedParts& parts,
                                  Carrying carrying) {
  std::vector<NamedField> fields = comm.on_all([&] {
    return input.job.with_metric ? meshadapt::named_fields(parts.part.wanted, "metric")
                                 : std::vector<NamedField>();
  });
  if (input.fields.empty()) return fields;
  auto carried =
      transfer_parts(comm, executor, {input.file.part, input.fields}, parts.part, {carrying});
  comm.on_all([&] { std::move(carried.begin(), carried.end(), std::back_inserter(fields)); });
  return fields;
}

/// On the first rank: as ductile adapt does, in a file each what the mesh's format does not hold.
void write_gathered(Input& input, meshadapt::MeshWithFields file) {
  const AdaptJob& job = input.job;
  meshadapt::AtomicOutputs outputs;
  const std::string ending = job.output.extension().string();
  std::vector<meshadapt::AnyField> of_files;
  std::size_t next = file.fields.size();
  for (const std::size_t count : input.field_count_of) next -= count;
  const std::size_t first = next;
  for (const std::size_t count : input.field_count_of) {
    const auto at = file.fields.begin() + static_cast<std::ptrdiff_t>(next);
    of_files.push_back(cli::side_by_side({at, at + static_cast<std::ptrdiff_t>(count)}, file.mesh));
    next += count;
  }
  std::vector<NamedField> inside(file.fields.begin(),
                                 file.fields.begin() + static_cast<std::ptrdiff_t>(first));
  for (NamedField& field : job.fields.named_fields(of_files)) inside.push_back(std::move(field));
  meshadapt::WriteOptions options;
  if (cli::holds_fields(job.output)) options.fields = inside;
  options.warnings = &input.warnings;
  options.format = ending;
  meshadapt::write_mesh(outputs, cli::place_of(job.output), file.mesh, options);
  if (job.metric_out)
    meshadapt::write_field(outputs, *job.metric_out,
                           cli::side_by_side({file.fields.front()}, file.mesh));
  job.fields.write(outputs, of_files);
  cli::print_warnings(input.warnings, job.verbosity);
  outputs.commit();
}

void write(const Communicator& comm, Input& input, const DistributedResult& result) {
  if (input.form != Form::gathered)
    on_first_rank(comm, [&] { cli::print_warnings(input.warnings, input.job.verbosity); });
  if (input.form == Form::pieces) return write_pieces(comm, input.output, result);
  if (input.form == Form::hdf5) return write_hdf5(comm, input.output, result);
  meshadapt::MeshWithFields file = gathered(comm, result);
  on_first_rank(comm, [&] { write_gathered(input, std::move(file)); });
}

void sum_up(const Communicator& comm, const Input& input, const AdaptedParts& parts) {
  const auto elements = static_cast<std::int64_t>(parts.part.element_count());
  const auto sums = comm.sums({parts.own, elements});
  const std::int64_t most = comm.largest(elements);
  if (comm.rank() != 0 || input.job.verbosity <= 0) return;
  std::fprintf(cli::is_standard_output(input.output) ? stderr : stdout,
               "%s: %s vertices, %s %s on %d ranks, %s on one at most\n",
               meshadapt::printable(input.output.string()).c_str(),
               cli::with_commas(static_cast<std::size_t>(sums[0])).c_str(),
               cli::with_commas(static_cast<std::size_t>(sums[1])).c_str(),
               parts.part.mesh.dimension == 2 ? "triangles" : "tetrahedra", comm.size(),
               cli::with_commas(static_cast<std::size_t>(most)).c_str());
}

void tell_costs_of_fields(const Communicator& comm, const Input& input, const Costs& before) {
  const auto microseconds =
      static_cast<std::int64_t>(1e6 * (comm.costs().seconds - before.seconds));
  const auto sums = comm.sums({microseconds, comm.costs().bytes - before.bytes});
  if (comm.rank() == 0 && input.job.verbosity > 1 && !input.fields.empty())
    std::printf("  fields %.3f s, %.3f MB\n", 1e-6 * static_cast<double>(sums[0]),
                1e-6 * static_cast<double>(sums[1]));
}

void work(const Communicator& comm, const Executor& executor, Input& input, Carrying carrying) {
  if (input.job.memory) comm.on_all([&] { cli::limit_memory(*input.job.memory); });
  on_first_rank(comm, [&] { read_files(input, executor); });
  tell_others(comm, input);
  AdaptedParts parts = adapted(comm, executor, input.file.part, options_of(comm, input.job));
  if (comm.rank() == 0 && input.job.verbosity > 1) print_costs(parts.last);
  const Costs before = comm.costs();
  auto fields = fields_of(comm, executor, input, parts, carrying);
  tell_costs_of_fields(comm, input, before);
  const DistributedResult result{std::move(parts), std::move(fields), input.file.kept, input.names,
                                 input.dropped_axis};
  write(comm, input, result);
  sum_up(comm, input, result.parts);
}

}  // namespace

void adapt_files(const Communicator& comm, std::span<const std::string> words) {
  Input input;
  on_first_rank(comm, [&] { read_words(input, Arguments(cli::adapt_command.options, words)); });
  const Carrying carrying = comm.on_all([&] {
    const Arguments arguments(cli::adapt_command.options, words);
    if (comm.rank() != 0) cli::set_options_of_work(input.job, arguments);
    return arguments.has("--interpolate") ? Carrying::by_value : Carrying::conservatively;
  });
  const int threads =
      threads_of(comm, input.job.threads > 0 ? std::optional(input.job.threads) : std::nullopt);
  const Executor executor = comm.on_all([&] { return Executor({.threads = threads}); });
  cli::reuse_memory(executor.threads());
  runtime::with_team(executor, [&] { work(comm, executor, input, carrying); });
}

void print_help_of_adapt() {
  const std::vector<Option> options = options_here();
  cli::Command command = cli::adapt_command;
  command.summary = "adapts a mesh to a metric, on all ranks that mpirun starts";
  command.details =
      "The first rank reads; planes share elements out; each rank adapts its part, and passes\n"
      "go on until hardly anything is held between parts. The same number of ranks gives the same bytes,\n"
      "whatever the number of threads.";
  command.options = options;
  cli::print_help(command, "mpirun -n N ductile-mpi");
}

}  // namespace ductile::petsc
