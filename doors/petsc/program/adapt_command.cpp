#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "adapt_job.hpp"
#include "adapt_to_sizes.hpp"
#include "distributed/adapt_parts.hpp"
#include "distributed/parts_geometry.hpp"
#include "distributed/pieces.hpp"
#include "distributed/threads.hpp"
#include "distributed/transfer_parts.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "files.hpp"
#include "first_rank.hpp"
#include "input.hpp"
#include "program.hpp"
#include "run_in_team.hpp"
#include "write_hdf5.hpp"

namespace ductile::petsc {

namespace {

using cli::AdaptJob;
using cli::Arguments;
using cli::Option;
using meshadapt::Carrying;
using meshadapt::NamedField;
using runtime::Executor;

/// The options of `ductile adapt` that are not available on several ranks, and the advice for them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> not_here{
    {{"--racing", "not in ductile-mpi; results are the same each time here; use ductile adapt"},
     {"--json", "not in ductile-mpi; use ductile info --json of the adapted mesh"},
     {"--vtu", "not in ductile-mpi; use -o OUT.pvtu, or ductile convert of the adapted mesh"}}};

/// The options whose help is another than in `ductile adapt`.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> other_help{
    {{"-o", "a mesh, gathered; a .pvtu, in pieces; a .h5, of PETSc's (default: NAME.o.mesh)"},
     {"--threads", "threads of each rank (default: its cores)"},
     {"-m", "takes at most this much memory on each rank, in MB"},
     {"--field", "carries fields, too, as those in the input; may be given again"}}};

/// The text for an option in one of these tables, or null.
const std::string_view* find(const auto& table, std::string_view option) {
  for (const auto& [name, text] : table)
    if (cli::without_dashes(name) == cli::without_dashes(option)) return &text;
  return nullptr;
}

std::string_view instead_of(std::string_view option) {
  const std::string_view* const advice = find(not_here, option);
  return advice != nullptr ? *advice : cli::instead_of_mmg_option(option);
}

std::vector<Option> options_here() {
  std::vector<Option> options;
  for (Option option : cli::adapt_command.options) {
    if (find(not_here, option.name) != nullptr) continue;
    if (const std::string_view* const help = find(other_help, option.name)) option.help = *help;
    options.push_back(option);
  }
  return options;
}

/// The geometry of -geometry, on all ranks; null without it. Collective.
std::shared_ptr<const meshadapt::Geometry> geometry_of(const Communicator& comm,
                                                       const Executor& executor,
                                                       const Input& input) {
  if (!input.job.geometry) return nullptr;
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
  if (job.memory) options.adapt.memory_limit = cli::memory_left(job.memory);
  if (comm.rank() == 0 && job.verbosity > 0)
    options.told = [](const PassReport& pass) {
      std::printf("%s\n", to_text(pass).c_str());
      std::fflush(stdout);
    };
  return options;
}

/// Transfers the input's fields to the adapted mesh. Collective.
std::vector<NamedField> fields_on(const Communicator& comm, const Executor& executor,
                                  const Input& input, const AdaptedParts& parts) {
  if (input.fields.empty()) return {};
  const auto carrying =
      input.job.fields.interpolates() ? Carrying::by_value : Carrying::conservatively;
  return transfer_parts(comm, executor, {input.file.part, input.fields}, parts.part, {carrying});
}

void write(const Communicator& comm, const Executor& executor, Input& input,
           DistributedResult& result) {
  if (input.form == Form::gathered) {
    const GatheredResult whole = gathered(comm, executor, result);
    return on_first_rank(comm, [&] {
      cli::write_outputs(input.job,
                         {whole.mesh, whole.metric, whole.fields, input.field_count_of, {}},
                         input.warnings);
    });
  }
  on_first_rank(comm, [&] { cli::print_warnings(input.warnings, input.job.verbosity); });
  if (input.job.with_metric)
    comm.on_all([&] {
      auto metric = meshadapt::named_fields(result.parts.part.wanted, "metric");
      result.fields.insert(result.fields.begin(), std::move(metric[0]));
    });
  if (input.form == Form::pieces) return write_pieces(comm, input.output, result);
  write_hdf5(comm, input.output, result);
}

void sum_up(const Communicator& comm, const Input& input, const AdaptedParts& parts) {
  const auto elements = static_cast<std::int64_t>(parts.part.element_count());
  const auto sums = comm.sums({parts.own, elements});
  const std::int64_t most = comm.largest(elements);
  if (comm.rank() != 0 || input.job.verbosity <= 0) return;
  const auto number = [](std::int64_t n) { return cli::with_commas(static_cast<std::size_t>(n)); };
  std::fprintf(cli::is_standard_output(input.output) ? stderr : stdout,
               "%s: %s vertices, %s %s on %d rank%s, %s on one at most\n",
               meshadapt::printable(input.output.string()).c_str(), number(sums[0]).c_str(),
               number(sums[1]).c_str(), parts.part.mesh.dimension == 2 ? "triangles" : "tetrahedra",
               comm.size(), comm.size() > 1 ? "s" : "", number(most).c_str());
}

int work(const Communicator& comm, const Executor& executor, Input& input) {
  if (input.job.memory) comm.on_all([&] { cli::limit_memory(*input.job.memory); });
  on_first_rank(comm, [&] { read_files(input, executor); });
  tell_others(comm, input);
  const auto options = options_of(comm, input, geometry_of(comm, executor, input));
  AdaptedParts parts = adapt_to_sizes(comm, executor, input, options);
  input.warnings.insert(input.warnings.end(), parts.warnings.begin(), parts.warnings.end());
  auto fields = fields_on(comm, executor, input, parts);
  DistributedResult result{std::move(parts), std::move(fields), input.file.kept};
  write(comm, executor, input, result);
  sum_up(comm, input, result.parts);
  return cli::done;
}

int run(const Arguments& arguments) {
  Input input = read_words(arguments);
  const Communicator comm(MPI_COMM_WORLD);
  try {
    on_first_rank(comm, [&] { check_files(input); });
    const int given = input.job.threads;
    const int threads = threads_of(comm, given > 0 ? std::optional(given) : std::nullopt);
    return cli::run_in_team({.threads = threads},
                            [&](const Executor& executor) { return work(comm, executor, input); });
  } catch (const AgreedError& error) {
    std::rethrow_if_nested(error);
    throw;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ductile-mpi: rank %d: %s\n", comm.rank(), error.what());
    MPI_Abort(MPI_COMM_WORLD, cli::failed);
    throw;
  }
}

}  // namespace

const cli::Command& adapt_command() {
  static const std::vector<Option> options = options_here();
  static const cli::Command command{
      cli::adapt_command.name,
      cli::adapt_command.operands,
      "adapts a mesh to a metric, on all ranks that mpirun starts",
      "The first rank reads; planes share elements out; each rank adapts its part, and passes\n"
      "go on until hardly anything is held between parts. The same number of ranks gives the same "
      "bytes,\n"
      "whatever the number of threads.",
      options,
      run,
      instead_of};
  return command;
}

}  // namespace ductile::petsc
