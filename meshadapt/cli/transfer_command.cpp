#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "extents.hpp"
#include "files.hpp"
#include "mesh/array_lengths.hpp"
#include "report.hpp"

namespace ductile::cli {

namespace {

constexpr std::array<Option, 6> options{{
    {"-o", "OUT", "a .sol, or NEW with fields (default: NEW.FIELD.sol, or NEW.o.vtu and the like)",
     "--out"},
    {"--interpolate", "", "carries all by their values, whatever becomes of integrals"},
    {"--by-value", "NAME", "carries this field by its values; may be given again"},
    {"--extend", "", "takes the closest values where NEW sticks out of OLD"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
    {"-v", "N", "0 says nothing, 1 (default) sums up", "--verbose"},
}};

/// The command line, checked before any file is read.
struct Job {
  fs::path from, to, output;
  std::vector<std::string> fields;  // files of them, or their names in OLD
  std::vector<std::string> by_value;
  bool interpolate = false, extend = false;
  int verbosity = 1;
};

// ---- The command line ----

/// NEW with fields, in its own format or that of the file with the fields, if one of them holds
/// fields; otherwise the fields alone.
fs::path default_output_of(const Job& job) {
  const auto file = std::find_if(job.fields.begin(), job.fields.end(), is_file);
  const fs::path source = file == job.fields.end() ? job.from : fs::path(*file);
  fs::path output = job.to;
  if (job.to == "/dev/stdin")
    throw UsageError("expected -o, because NEW is read from standard input, found none");
  if (holds_fields(job.to)) return default_output(job.to);
  if (holds_fields(source)) return output.replace_extension(".o" + source.extension().string());
  if (job.fields.size() != 1 || !is_file(job.fields[0]))
    throw UsageError("expected -o, because no name follows from those of the inputs, found none");
  const std::string ending = field_beside(job.to).extension().string();
  return output.replace_extension("." + source.stem().string() + ending);
}

void set_files(Job& job, const Arguments& arguments) {
  const auto& words = arguments.operands();
  if (words.size() < 2)
    throw UsageError("expected OLD, maybe fields, and NEW, found " + std::to_string(words.size()) +
                     (words.size() == 1 ? " file" : " files"));
  job.from = input_of(words.front());
  job.to = input_of(words.back());
  if (job.from == "/dev/stdin" && job.to == job.from)
    throw UsageError("expected one mesh from standard input, found both");
  job.fields.assign(words.begin() + 1, words.end() - 1);
  const auto out = arguments.text("-o");
  job.output = out ? output_of(*out) : default_output_of(job);
  expect_fields_held(job.output);
  std::vector<fs::path> inputs{job.from};
  for (const std::string& word : job.fields)
    if (is_file(word)) inputs.emplace_back(word);
  if (holds_field(job.output)) inputs.push_back(job.to);
  expect_no_input(job.output, inputs);
}

Job read_job(const Arguments& arguments) {
  Job job;
  set_files(job, arguments);
  job.by_value = arguments.texts("--by-value");
  job.interpolate = arguments.has("--interpolate");
  job.extend = arguments.has("--extend");
  job.verbosity = verbosity_of(arguments);
  check_writable(place_of(job.output));
  return job;
}

// ---- Which fields ----

void append(std::vector<NamedField>& to, std::vector<NamedField> fields) {
  for (NamedField& field : fields) {
    for (const NamedField& other : to)
      if (other.name == field.name && other.place == field.place)
        throw UsageError("two fields are called '" + field.name +
                         "'; give each of them once, and files different names");
    to.push_back(std::move(field));
  }
}

std::vector<NamedField> called(const std::string& name, const MeshWithFields& file) {
  std::vector<NamedField> found;
  for (const NamedField& field : file.fields)
    if (field.name == name) found.push_back(field);
  if (found.empty())
    throw InputError(file.mesh.name + ": expected a field '" + name + "', found " +
                     (file.fields.empty() ? "none" : names_of(file.fields)) +
                     "; give one of its fields, or a file of fields that is there");
  return found;
}

std::vector<NamedField> chosen_fields(const Job& job, const MeshWithFields& file,
                                      Warnings& warnings) {
  std::vector<NamedField> fields;
  for (const std::string& word : job.fields)
    append(fields,
           is_file(word) ? read_named_fields(word, file.mesh, warnings) : called(word, file));
  if (job.fields.empty()) append(fields, file.fields);
  if (fields.empty())
    throw InputError((job.fields.empty() ? file.mesh.name : job.fields[0]) +
                     ": expected fields, found none; give a file of them between OLD and NEW");
  return fields;
}

/// Chooses how each field is carried. A metric goes by its values, so that it stays positive
/// definite. Whole numbers on elements are marks and go by value: a new element gets that of the
/// old one in which its centroid lies.
std::vector<Carrying> ways(const Job& job, const std::vector<NamedField>& fields) {
  for (const std::string& name : job.by_value)
    if (std::none_of(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; }))
      throw UsageError("option --by-value: expected one of " + names_of(fields) + ", found '" +
                       name + "'");
  std::vector<Carrying> carrying;
  for (const NamedField& field : fields) {
    const bool by_value =
        job.interpolate || field.name == "metric" || (field.whole && !is_at_vertices(field)) ||
        std::find(job.by_value.begin(), job.by_value.end(), field.name) != job.by_value.end();
    carrying.push_back(by_value ? Carrying::by_value : Carrying::conservatively);
  }
  return carrying;
}

// ---- Whether both meshes cover the same domain ----
//
// More fields are carried for that: the positions of the old vertices, which arrive as the closest
// points of the old mesh, and the sizes of its elements, because facets of a curved boundary are
// off by a fraction of that.

/// The meshes from and to which fields are carried.
struct Passage {
  const AnyMesh &from, &to;
};

/// Rounding to seven digits leaves this share of a mesh outside of an equal one.
constexpr double rounding = 1e-6;

void each_element(const AnyMesh& mesh, auto&& visit) {
  const auto all = [&](const auto& cells) {
    for (const auto& corners : cells.vertices) visit(std::span<const std::uint32_t>(corners));
  };
  mesh.dimension == 2 ? all(mesh.triangles) : all(mesh.tetrahedra);
}

/// [vertex] The longest edge of the elements around it.
std::vector<double> sizes_of(const AnyMesh& mesh) {
  std::vector<double> size_of(mesh.vertex_count());
  each_element(mesh, [&](std::span<const std::uint32_t> corners) {
    for (const std::uint32_t a : corners)
      for (const std::uint32_t b : corners)
        size_of[a] = std::max(size_of[a], norm(position(mesh, a) - position(mesh, b)));
  });
  return size_of;
}

double volume(const AnyMesh& mesh) {
  double sum = 0;
  each_element(mesh,
               [&](std::span<const std::uint32_t> corners) { sum += measure(mesh, corners); });
  return sum;
}

/// "0.3 % of its area".
std::string share(double part, const AnyMesh& mesh) {
  return format("%.3g %% of its ", std::min(100.0, 100 * part / volume(mesh))) +
         (mesh.dimension == 2 ? "area" : "volume");
}

[[noreturn]] void refuse(const Passage& meshes, const std::string& what) {
  throw InputError(meshes.to.name + ": " + what + " outside of " + meshes.from.name +
                   "; give a mesh of the same domain, or --extend to take the closest " +
                   "values there");
}

void expect_vertices_inside(const Passage& meshes, const std::vector<double>& closest,
                            const std::vector<double>& size_of) {
  constexpr double most = 0.25;
  double worst = most;
  std::size_t farthest = meshes.to.vertex_count();
  const auto outside = [&](std::size_t v) {
    const auto dimension = static_cast<std::size_t>(meshes.to.dimension);
    Position gap = position(meshes.to, v);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      gap.x[axis] -= closest[v * dimension + axis];
    return norm(gap);
  };
  each_element(meshes.to, [&](std::span<const std::uint32_t> corners) {
    for (const std::uint32_t v : corners)
      if (const double d = outside(v); d > worst * size_of[v]) {
        worst = d / size_of[v];
        farthest = v;
      }
  });
  if (farthest < meshes.to.vertex_count())
    refuse(meshes, format("vertex %zu lies %.3g", farthest + 1, outside(farthest)));
}

/// Appends the additional fields to those of this mesh.
void add_probes(const AnyMesh& mesh, std::vector<NamedField>& fields,
                std::vector<Carrying>& carrying) {
  using Place = NamedField::Place;
  const bool conservative =
      std::find(carrying.begin(), carrying.end(), Carrying::conservatively) != carrying.end();
  fields.push_back({"place", AnyField::Type::vector, mesh.coordinates, Place::vertices});
  fields.push_back({"size", AnyField::Type::scalar, sizes_of(mesh), Place::vertices});
  carrying.insert(carrying.end(), 2, Carrying::by_value);
  if (conservative) return;  // so it is known how much is outside
  fields.push_back({"volume", AnyField::Type::scalar, std::vector<double>(element_count(mesh)),
                    Place::elements});
  carrying.push_back(Carrying::conservatively);
}

/// Throws InputError if a vertex of the new mesh lies farther outside than a quarter of an element
/// of the old one, or more than a hundredth of the new mesh does. `first` is the index of what
/// add_probes() appended.
void expect_same_domain(const Passage& meshes, const TransferredFields& carried,
                        std::size_t first) {
  expect_vertices_inside(meshes, carried.fields[first].values, carried.fields[first + 1].values);
  if (carried.report.volume_outside > 0.01 * volume(meshes.to))
    refuse(meshes, share(carried.report.volume_outside, meshes.to) + " lies");
}

/// Warns if the new mesh is larger, where values are the closest ones.
void warn_of_extension(const Passage& meshes, const TransferReport& report, Warnings& warnings) {
  if (report.volume_outside > rounding * volume(meshes.to))
    warnings.push_back(meshes.to.name + ": " + share(report.volume_outside, meshes.to) +
                       " is not in " + meshes.from.name + "; values there are the closest ones");
}

/// Warns if the old mesh is larger, which costs integrals a part.
void warn_of_loss(const Passage& meshes, const TransferReport& report, Warnings& warnings) {
  if (report.volume_left_out > rounding * volume(meshes.from))
    warnings.push_back(meshes.from.name + ": " + share(report.volume_left_out, meshes.from) +
                       " is not in " + meshes.to.name + "; integrals lose what is there");
}

// ---- The work ----

std::vector<NamedField> carry(const runtime::Executor& executor, const Job& job,
                              const Passage& meshes, std::vector<NamedField> fields,
                              Warnings& warnings) {
  if (meshes.to.dimension != meshes.from.dimension)
    throw InputError(meshes.to.name + ": expected a mesh of dimension " +
                     std::to_string(meshes.from.dimension) + ", that of " + meshes.from.name +
                     ", found " + std::to_string(meshes.to.dimension) +
                     "; give a mesh of the same domain");
  std::vector<Carrying> carrying = ways(job, fields);
  const std::size_t count = fields.size();
  const bool keeps_integrals =
      std::find(carrying.begin(), carrying.end(), Carrying::conservatively) != carrying.end();
  add_probes(meshes.from, fields, carrying);
  auto carried = transfer_fields(executor, {meshes.from, fields}, meshes.to, carrying);
  if (!job.extend) expect_same_domain(meshes, carried, count);
  warn_of_extension(meshes, carried.report, warnings);
  if (keeps_integrals) warn_of_loss(meshes, carried.report, warnings);
  carried.fields.resize(count);
  return std::move(carried.fields);
}

/// Keeps the fields of NEW, except those that carried fields of the same name replace.
void add_own_fields(std::vector<NamedField>& carried, std::vector<NamedField> own) {
  const std::size_t count = carried.size();
  for (NamedField& field : own)
    if (std::none_of(carried.begin(), carried.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const NamedField& other) {
                       return other.name == field.name && other.place == field.place;
                     }))
      carried.push_back(std::move(field));
}

/// Leaves out fields that a .sol cannot hold.
void keep_those_at_vertices(const Job& job, std::vector<NamedField>& carried, Warnings& warnings) {
  std::vector<NamedField> others;
  for (const NamedField& field : carried)
    if (!is_at_vertices(field)) others.push_back(field);
  if (others.empty()) return;
  const std::string what = job.output.string() + ": holds fields at vertices only, not " +
                           names_of(others) + " on elements; ";
  if (others.size() == carried.size())
    throw InputError(what + "give the output a name ending in .vtu");
  std::erase_if(carried, [](const NamedField& field) { return !is_at_vertices(field); });
  warnings.push_back(what + "a .vtu takes both");
}

std::string summary(const Job& job, const std::vector<NamedField>& carried, const AnyMesh& mesh) {
  std::vector<NamedField> at_vertices, on_elements;
  for (const NamedField& field : carried)
    (is_at_vertices(field) ? at_vertices : on_elements).push_back({field.name, field.type, {}, {}});
  std::string text;
  if (!at_vertices.empty())
    text += "at " + counted(mesh.vertex_count(), "vertex", "vertices") + ": " +
            printable(names_of(at_vertices)) + "\n";
  if (!on_elements.empty())
    text += "on " +
            (mesh.dimension == 2 ? counted(mesh.triangles.size(), "triangle", "triangles")
                                 : counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra")) +
            ": " + printable(names_of(on_elements)) + "\n";
  return text + "written: " + printable(place_of(job.output).string()) + "\n";
}

/// Writes the output, which appears on commit().
void stage(AtomicOutputs& outputs, const Job& job, MeshWithFields& to,
           std::vector<NamedField> carried, Warnings& warnings) {
  using Form = WriteOptions::Form;
  const std::string ending = job.output.extension().string();
  if (holds_field(job.output)) {
    write_field(outputs, place_of(job.output), side_by_side(carried, to.mesh),
                {.form = ending == ".sol" ? Form::ascii : Form::binary});
    return;
  }
  add_own_fields(carried, std::move(to.fields));
  write_mesh(outputs, place_of(job.output), to.mesh,
             {.fields = carried, .format = ending, .warnings = &warnings});
}

int work(const runtime::Executor& executor, const Job& job) {
  Warnings warnings;
  const MeshWithFields from = read_mesh_with_fields(job.from, &warnings);
  MeshWithFields to = read_mesh_with_fields(job.to, &warnings);
  std::vector<NamedField> carried =
      carry(executor, job, {from.mesh, to.mesh}, chosen_fields(job, from, warnings), warnings);
  if (holds_field(job.output)) keep_those_at_vertices(job, carried, warnings);
  const std::string said = job.verbosity > 0 ? summary(job, carried, to.mesh) : std::string();
  AtomicOutputs outputs;
  stage(outputs, job, to, std::move(carried), warnings);
  print_warnings(warnings, job.verbosity);
  outputs.commit();
  // From here on no memory is taken, because the output is there.
  std::fputs(said.c_str(), is_standard_output(job.output) ? stderr : stdout);
  return done;
}

int run(const Arguments& arguments) {
  const Job job = read_job(arguments);
  return run_in_team({.threads = threads_of(arguments)},
                     [&](const runtime::Executor& executor) { return work(executor, job); });
}

}  // namespace

const Command transfer_command{
    "transfer",
    "OLD [FIELD...] NEW [-o OUT]",
    "carries fields to another mesh of the same domain",
    "FIELD is a file of fields on OLD, a .sol or one that holds a mesh and fields, or the name of\n"
    "a field in OLD; without any, all that OLD has are carried. Fields at vertices and on "
    "elements\n"
    "keep their integrals and bounds, or their values where that is asked for; one that is called\n"
    "metric, and whole numbers on elements, go by their values.",
    options,
    run};

}  // namespace ductile::cli
