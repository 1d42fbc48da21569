#include "input.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "files.hpp"
#include "first_rank.hpp"

namespace ductile::petsc {

namespace fs = std::filesystem;
using cli::AdaptJob;
using cli::Arguments;
using meshadapt::NamedField;
using runtime::Executor;

namespace {

/// Takes the fields in the mesh's file, if the output holds fields, and those of --field. Of two
/// with one name the latter stays.
void take_fields(Input& input, cli::AdaptInput& read) {
  const std::vector<NamedField>& given = read.fields.fields;
  std::erase_if(read.file.fields, [&](const NamedField& field) {
    return field.name == "metric" ||
           std::any_of(given.begin(), given.end(), [&](const auto& other) {
             return other.name == field.name && other.place == field.place;
           });
  });
  if (cli::holds_fields(input.job.output))
    input.fields = std::move(read.file.fields);
  else if (!read.file.fields.empty())
    input.warnings.push_back(read.file.mesh.name + ": its fields are left out, which " +
                             input.job.output.string() +
                             " does not hold: " + cli::names_of(read.file.fields));
  input.fields.insert(input.fields.end(), given.begin(), given.end());
  input.field_count_of = std::move(read.fields.count_of);
}

/// Reads a mesh that only describes boundaries.
Part read_geometry(Input& input, const Executor& executor) {
  AnyMesh mesh = meshadapt::read_mesh(*input.job.geometry, &input.warnings);
  const int dimension = input.file.part.mesh.dimension;
  if (mesh.dimension != dimension)
    throw meshadapt::InputError(mesh.name + ": expected a geometry of dimension " +
                                std::to_string(dimension) + ", found " +
                                std::to_string(mesh.dimension));
  if (input.job.adapt.make.complete_boundary) meshadapt::list_boundary(executor, mesh);
  if (dimension == 2) mesh.required_edges.clear();  // edges are facets in 2D and irrelevant here
  mesh.required_triangles.clear();
  mesh.required_tetrahedra.clear();
  return part_of_file(executor, std::move(mesh), {}, input.warnings).part;
}

/// Data of a field, or of the name of a reference, sent to other ranks.
struct Told {
  std::array<char, 240> name{};
  int number = 0, other = 0;

  Told() = default;
  Told(const std::string& text, int first, int second) : number(first), other(second) {
    std::copy_n(text.data(), std::min(text.size(), name.size() - 1), name.begin());
  }
};

}  // namespace

/// A .pvtu and a .h5 hold fields like a .vtu, whose name is used in place of theirs.
Input read_words(const Arguments& arguments) {
  Input input;
  const fs::path given = arguments.text("-o").value_or("");
  if (given.extension() == ".pvtu") input.form = Form::pieces;
  if (given.extension() == ".h5" || given.extension() == ".hdf5") input.form = Form::hdf5;
  const bool is_gathered = input.form == Form::gathered;
  input.job = cli::adapt_job(arguments, is_gathered ? std::optional<fs::path>()
                                                    : fs::path(given).replace_extension(".vtu"));
  if (arguments.has("-lag"))
    throw cli::UsageError(
        "option -lag: expected none with several processes, found one; move the mesh with `ductile "
        "move`");
  if (input.job.level_set)
    throw cli::UsageError(
        "option -ls: expected none with several processes, found one; cut the mesh with `ductile "
        "adapt -ls` first");
  input.output = is_gathered ? input.job.output : given;
  return input;
}

void check_files(Input& input) {
  cli::check_files(input.job);
  if (input.form != Form::gathered) meshadapt::check_writable(input.output);
}

void read_files(Input& input, const Executor& executor) {
  AdaptJob& job = input.job;
  cli::AdaptInput read = cli::read_input(executor, job, input.warnings);
  AnyMesh& mesh = read.file.mesh;
  if (job.places.any())
    input.places.emplace(mesh, read.sizes,
                         meshadapt::SizeBounds{job.adapt.smallest_size, job.adapt.largest_size});
  if (job.adapt.make.complete_boundary) meshadapt::list_boundary(executor, mesh);
  auto metric =
      meshadapt::metric_of(read.metric, mesh, {job.adapt.smallest_size, job.adapt.largest_size});
  take_fields(input, read);
  input.file = part_of_file(executor, std::move(mesh), std::move(metric), input.warnings);
  if (job.geometry) input.geometry = read_geometry(input, executor);
}

void tell_others(const Communicator& comm, Input& input) {
  Kept& kept = input.file.kept;
  int dimension = input.file.part.mesh.dimension;
  from_first_rank(comm, dimension);
  from_first_rank(comm, input.job.adapt.smallest_size);
  from_first_rank(comm, input.job.adapt.largest_size);
  from_first_rank(comm, kept.vertices);
  from_first_rank(comm, kept.facets);
  from_first_rank(comm, kept.elements);
  from_first_rank(comm, kept.dropped_axis);
  std::vector<Told> fields, names;
  std::string mesh = input.file.part.mesh.name;
  comm.on_all([&] {
    for (const NamedField& field : input.fields)
      fields.emplace_back(field.name, static_cast<int>(field.type), static_cast<int>(field.place));
    for (const auto& name : kept.names)
      names.emplace_back(name.name, name.reference, name.dimension);
  });
  from_first_rank(comm, fields);
  from_first_rank(comm, names);
  from_first_rank(comm, mesh);
  if (comm.rank() == 0) return;
  input.file.part = empty_part(dimension);
  input.file.part.mesh.name = mesh;
  for (const Told& field : fields)
    input.fields.push_back({field.name.data(),
                            static_cast<meshadapt::AnyField::Type>(field.number),
                            {},
                            static_cast<NamedField::Place>(field.other)});
  for (const Told& name : names) kept.names.push_back({name.other, name.number, name.name.data()});
}

}  // namespace ductile::petsc
