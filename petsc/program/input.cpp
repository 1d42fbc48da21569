#include "input.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "files.hpp"
#include "first_rank.hpp"
#include "listed.hpp"
#include "local_parameters.hpp"

namespace ductile::petsc {

namespace fs = std::filesystem;
using cli::AdaptJob;
using cli::Arguments;
using meshadapt::NamedField;
using runtime::Executor;

namespace {

void refuse_what_is_not_here(const Arguments& arguments) {
  for (const auto& [option, instead] : not_here)
    if (arguments.has(option))
      throw cli::UsageError("option " + std::string(option) + ": not in ductile-mpi; " +
                            std::string(instead));
}

/// Reads the fields in the file of the mesh, if the output holds fields, and those of --field.
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
  std::vector<std::string> taken = {"metric"};
  for (const NamedField& field : input.fields) taken.push_back(field.name);
  const auto values = job.fields.read(file.mesh, input.warnings, std::move(taken));
  input.field_count_of = values.field_count_of;
  if (values.field_count_of.empty()) return;
  for (NamedField& field : cli::CarriedFields::named_fields({values.all}, values.names))
    input.fields.push_back(std::move(field));
}

/// Removes listed edges that belong to no tetrahedron, as adapt() does: no part would have them.
void drop_loose_edges(const Executor& executor, AnyMesh& mesh, meshadapt::Warnings& warnings) {
  if (mesh.dimension != 3 || mesh.edges.size() == 0) return;
  const auto around = elements_around<3>(executor, mesh);
  const std::vector<Marks> marks = marks_of(mesh, mesh.edges);
  const auto all = std::exchange(mesh.edges, {});
  mesh.ridges.clear();
  mesh.required_edges.clear();
  std::size_t first = all.size();  // the first loose one
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool is_loose = true;
    visit_beside<3>(mesh, around, all.vertices[i], [&](std::uint32_t) { is_loose = false; });
    if (!is_loose)
      list(mesh, all.vertices[i], all.reference[i], marks[i]);
    else
      first = std::min(first, i);
  }
  if (const std::size_t loose = all.size() - mesh.edges.size(); loose > 0)
    warnings.push_back(
        mesh.name + ": " + std::to_string(loose) + " of " + std::to_string(all.size()) +
        " listed edges belong to no tetrahedron and are left out; the first is edge " +
        std::to_string(first + 1));
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
  return part_of_file(std::move(mesh), {}, input.warnings).part;
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

void read_files(Input& input, const Executor& executor) {
  AdaptJob& job = input.job;
  if (!job.unneeded.empty()) input.warnings.push_back(job.unneeded);
  auto file = meshadapt::read_mesh_with_fields(job.input, &input.warnings);
  if (job.adapt.make.complete_boundary) meshadapt::list_boundary(executor, file.mesh);
  drop_loose_edges(executor, file.mesh, input.warnings);
  const meshadapt::Sizes sizes = job.places.sizes_for(file.mesh, input.warnings);
  meshadapt::AnyField metric = cli::choose_metric(executor, job, file, sizes, input.warnings);
  if (job.places.any())
    input.places.emplace(file.mesh, sizes,
                         meshadapt::SizeBounds{job.adapt.smallest_size, job.adapt.largest_size});
  else
    cli::bound_locally(executor, file.mesh,
                       cli::local_parameters(job.parameters, file.mesh, job.adapt, input.warnings),
                       metric, job.adapt);
  metric =
      meshadapt::metric_of(metric, file.mesh, {job.adapt.smallest_size, job.adapt.largest_size});
  read_fields(input, file);
  input.names = file.mesh.names;
  input.dropped_axis = file.mesh.dropped_axis;
  input.file = part_of_file(std::move(file.mesh), std::move(metric), input.warnings);
  if (job.geometry) input.geometry = read_geometry(input, executor);
}

void tell_others(const Communicator& comm, Input& input) {
  int dimension = input.file.part.mesh.dimension;
  std::array<double, 2> bounds{input.job.adapt.smallest_size, input.job.adapt.largest_size};
  from_first_rank(comm, dimension);
  from_first_rank(comm, bounds);
  from_first_rank(comm, input.form);
  from_first_rank(comm, input.dropped_axis);
  from_first_rank(comm, input.job.with_metric);
  from_first_rank(comm, input.file.kept.vertices);
  from_first_rank(comm, input.file.kept.facets);
  from_first_rank(comm, input.file.kept.elements);
  std::vector<Told> fields, names;
  std::string output = input.output.string(), mesh = input.file.part.mesh.name;
  comm.on_all([&] {
    if (comm.rank() != 0) return;
    for (const NamedField& field : input.fields)
      fields.emplace_back(field.name, static_cast<int>(field.type), static_cast<int>(field.place));
    for (const auto& name : input.names)
      names.emplace_back(name.name, name.reference, name.dimension);
  });
  from_first_rank(comm, fields);
  from_first_rank(comm, names);
  from_first_rank(comm, output);
  from_first_rank(comm, mesh);
  input.job.adapt.smallest_size = bounds[0];
  input.job.adapt.largest_size = bounds[1];
  if (comm.rank() == 0) return;
  input.output = output;
  input.file.part = empty_part(dimension);
  input.file.part.mesh.name = mesh;
  for (const Told& field : fields)
    input.fields.push_back({field.name.data(),
                            static_cast<meshadapt::AnyField::Type>(field.number),
                            {},
                            static_cast<NamedField::Place>(field.other)});
  for (const Told& name : names) input.names.push_back({name.other, name.number, name.name.data()});
}

}  // namespace ductile::petsc
