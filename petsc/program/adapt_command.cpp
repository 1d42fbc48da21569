#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adapt_job.hpp"
#include "adapt_parts.hpp"
#include "adapt_to_sizes.hpp"
#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/runtime/process.hpp"
#include "file_part.hpp"
#include "files.hpp"
#include "first_rank.hpp"
#include "input.hpp"
#include "outputs.hpp"
#include "parts_geometry.hpp"
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
using runtime::Executor;

std::vector<Option> options_here() {
  std::vector<Option> options;
  for (Option option : cli::adapt_command.options) {
    if (std::any_of(not_here.begin(), not_here.end(),
                    [&](const NotHere& one) { return one.option == option.name; }))
      continue;
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

/// Prints costs over all ranks.
void print_costs(const std::array<Costs, phase_count>& costs) {
  constexpr std::array<const char*, phase_count> names{"balance", "migration", "gradation",
                                                       "adaptation"};
  for (std::size_t p = 0; p < phase_count; ++p)
    std::printf("%s%s %.3f s, %.3f MB", p == 0 ? "  processor time and messages: " : "; ", names[p],
                costs[p].seconds, 1e-6 * static_cast<double>(costs[p].bytes));
  std::printf("\n");
}

/// The geometry of -geometry, on all ranks; null without it. Collective.
std::shared_ptr<const meshadapt::Geometry> geometry_of(const Communicator& comm,
                                                       const Executor& executor,
                                                       const Input& input) {
  bool is_given = input.geometry.has_value();
  from_first_rank(comm, is_given);
  if (!is_given) return nullptr;
  const Part none = empty_part(input.file.part.mesh.dimension);
  return geometry_of_parts(comm, executor, input.geometry ? *input.geometry : none,
                           input.job.adapt.make);
}

AdaptPartsOptions options_of(const Communicator& comm, const Input& input,
                             std::shared_ptr<const meshadapt::Geometry> geometry) {
  const AdaptJob& job = input.job;
  AdaptPartsOptions options;
  for (const KeptReference& kept : input.file.kept.facets)
    options.required_facets.push_back(kept.label);
  for (const KeptReference& kept : input.file.kept.elements)
    options.required_elements.push_back(kept.label);
  options.adapt = job.adapt;
  options.adapt.make.geometry = std::move(geometry);
  options.adapt.make.complete_boundary = false;  // parts list their own
  if (options.adapt.required_gradation <= 0 && comm.size() > 1)
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

/// The fields of the output: the metric, if wanted, and the transferred fields.
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

/// Writes on the first rank: like ductile adapt, with separate files for data that the mesh's
/// format cannot hold.
void write_gathered(Input& input, meshadapt::MeshWithFields file) {
  const AdaptJob& job = input.job;
  meshadapt::AtomicOutputs outputs;
  const std::string ending = job.output.extension().string();
  std::vector<meshadapt::AnyField> of_files;
  std::size_t next = file.fields.size();
  for (const std::size_t count : input.field_count_of) next -= count;
  for (const std::size_t count : input.field_count_of) {
    const auto at = file.fields.begin() + static_cast<std::ptrdiff_t>(next);
    of_files.push_back(cli::side_by_side({at, at + static_cast<std::ptrdiff_t>(count)}, file.mesh));
    next += count;
  }
  meshadapt::WriteOptions options;
  if (cli::holds_fields(job.output)) options.fields = file.fields;
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

void write(const Communicator& comm, const Executor& executor, Input& input,
           const DistributedResult& result) {
  if (input.form != Form::gathered)
    on_first_rank(comm, [&] { cli::print_warnings(input.warnings, input.job.verbosity); });
  if (input.form == Form::pieces) return write_pieces(comm, input.output, result);
  if (input.form == Form::hdf5) return write_hdf5(comm, input.output, result);
  meshadapt::MeshWithFields file = gathered(comm, executor, result);
  on_first_rank(comm, [&] { write_gathered(input, std::move(file)); });
}

void sum_up(const Communicator& comm, const Input& input, const AdaptedParts& parts) {
  const auto elements = static_cast<std::int64_t>(parts.part.element_count());
  const auto sums = comm.sums({parts.own, elements});
  const std::int64_t most = comm.largest(elements);
  if (comm.rank() != 0 || input.job.verbosity <= 0) return;
  std::fprintf(cli::is_standard_output(input.output) ? stderr : stdout,
               "%s: %s vertices, %s %s on %d rank%s, %s on one at most\n",
               meshadapt::printable(input.output.string()).c_str(),
               cli::with_commas(static_cast<std::size_t>(sums[0])).c_str(),
               cli::with_commas(static_cast<std::size_t>(sums[1])).c_str(),
               parts.part.mesh.dimension == 2 ? "triangles" : "tetrahedra", comm.size(),
               comm.size() > 1 ? "s" : "",
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
  const auto options = options_of(comm, input, geometry_of(comm, executor, input));
  AdaptedParts parts = adapt_to_sizes(comm, executor, input, options);
  input.warnings.insert(input.warnings.end(), parts.warnings.begin(), parts.warnings.end());
  if (comm.rank() == 0 && input.job.verbosity > 1) print_costs(parts.last);
  const Costs before = comm.costs();
  auto fields = fields_of(comm, executor, input, parts, carrying);
  tell_costs_of_fields(comm, input, before);
  const DistributedResult result{std::move(parts), std::move(fields), input.file.kept, input.names,
                                 input.dropped_axis};
  write(comm, executor, input, result);
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
      "go on until hardly anything is held between parts. The same number of ranks gives the same "
      "bytes,\n"
      "whatever the number of threads.";
  command.options = options;
  cli::print_help(command, "mpirun -n N ductile-mpi");
}

}  // namespace ductile::petsc
