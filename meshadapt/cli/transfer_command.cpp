#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/transfer.hpp"
#include "files.hpp"
#include "run_in_team.hpp"
#include "same_domain.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;
using meshadapt::Carrying;
using meshadapt::MeshWithFields;
using meshadapt::NamedField;

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
  int threads = 0, verbosity = 1;
};

// ---- The command line ----

bool is_field_file(const fs::path& path) {
  return path.extension() == ".sol" || path.extension() == ".solb";
}

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
  if (!is_field_file(job.output) && !holds_fields(job.output))
    throw UsageError(
        "option -o: expected a name ending in .sol or .solb, or of a format that "
        "holds a mesh and fields, found '" +
        job.output.string() + "'");
  std::vector<fs::path> inputs{job.from};
  for (const std::string& word : job.fields)
    if (is_file(word)) inputs.emplace_back(word);
  if (is_field_file(job.output)) inputs.push_back(job.to);
  expect_no_input(job.output, inputs);
}

Job read_job(const Arguments& arguments) {
  Job job;
  set_files(job, arguments);
  job.by_value = arguments.texts("--by-value");
  job.interpolate = arguments.has("--interpolate");
  job.extend = arguments.has("--extend");
  job.threads = arguments.integer("--threads", 1, 4096).value_or(0);
  job.verbosity = arguments.integer("-v", -1, 10).value_or(1);
  meshadapt::check_writable(place_of(job.output));
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
    throw meshadapt::InputError(file.mesh.name + ": expected a field '" + name + "', found " +
                                (file.fields.empty() ? "none" : names_of(file.fields)) +
                                "; give one of its fields, or a file of fields that is there");
  return found;
}

std::vector<NamedField> chosen_fields(const Job& job, const MeshWithFields& file,
                                      meshadapt::Warnings& warnings) {
  std::vector<NamedField> fields;
  for (const std::string& word : job.fields)
    append(fields,
           is_file(word) ? read_named_fields(word, file.mesh, warnings) : called(word, file));
  if (job.fields.empty()) append(fields, file.fields);
  if (fields.empty())
    throw meshadapt::InputError(
        (job.fields.empty() ? file.mesh.name : job.fields[0]) +
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

// ---- The work ----

std::vector<NamedField> carry(const runtime::Executor& executor, const Job& job,
                              const Passage& meshes, std::vector<NamedField> fields,
                              meshadapt::Warnings& warnings) {
  if (meshes.to.dimension != meshes.from.dimension)
    throw meshadapt::InputError(
        meshes.to.name + ": expected a mesh of dimension " + std::to_string(meshes.from.dimension) +
        ", that of " + meshes.from.name + ", found " + std::to_string(meshes.to.dimension) +
        "; give a mesh of the same domain");
  std::vector<Carrying> carrying = ways(job, fields);
  const std::size_t count = fields.size();
  const bool keeps_integrals =
      std::find(carrying.begin(), carrying.end(), Carrying::conservatively) != carrying.end();
  add_probes(meshes.from, fields, carrying);
  auto carried = meshadapt::transfer_fields(executor, {meshes.from, fields}, meshes.to, carrying);
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
void keep_those_at_vertices(const Job& job, std::vector<NamedField>& carried,
                            meshadapt::Warnings& warnings) {
  std::vector<NamedField> others;
  for (const NamedField& field : carried)
    if (!is_at_vertices(field)) others.push_back(field);
  if (others.empty()) return;
  const std::string what = job.output.string() + ": holds fields at vertices only, not " +
                           names_of(others) + " on elements; ";
  if (others.size() == carried.size())
    throw meshadapt::InputError(what + "give the output a name ending in .vtu");
  std::erase_if(carried, [](const NamedField& field) { return !is_at_vertices(field); });
  warnings.push_back(what + "a .vtu takes both");
}

std::string summary(const Job& job, const std::vector<NamedField>& carried,
                    const meshadapt::AnyMesh& mesh) {
  std::vector<NamedField> at_vertices, on_elements;
  for (const NamedField& field : carried)
    (is_at_vertices(field) ? at_vertices : on_elements).push_back({field.name, field.type, {}, {}});
  std::string text;
  if (!at_vertices.empty())
    text += "at " + counted(mesh.vertex_count(), "vertex", "vertices") + ": " +
            meshadapt::printable(names_of(at_vertices)) + "\n";
  if (!on_elements.empty())
    text += "on " +
            (mesh.dimension == 2 ? counted(mesh.triangles.size(), "triangle", "triangles")
                                 : counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra")) +
            ": " + meshadapt::printable(names_of(on_elements)) + "\n";
  return text + "written: " + meshadapt::printable(place_of(job.output).string()) + "\n";
}

/// Writes the output, which appears on commit().
void stage(meshadapt::AtomicOutputs& outputs, const Job& job, MeshWithFields& to,
           std::vector<NamedField> carried, meshadapt::Warnings& warnings) {
  using Form = meshadapt::WriteOptions::Form;
  const std::string ending = job.output.extension().string();
  if (is_field_file(job.output)) {
    meshadapt::write_field(outputs, place_of(job.output), side_by_side(carried, to.mesh),
                           {.form = ending == ".sol" ? Form::ascii : Form::binary});
    return;
  }
  add_own_fields(carried, std::move(to.fields));
  meshadapt::write_mesh(outputs, place_of(job.output), to.mesh,
                        {.fields = carried, .format = ending, .warnings = &warnings});
}

int work(const runtime::Executor& executor, const Job& job) {
  meshadapt::Warnings warnings;
  const MeshWithFields from = meshadapt::read_mesh_with_fields(job.from, &warnings);
  MeshWithFields to = meshadapt::read_mesh_with_fields(job.to, &warnings);
  std::vector<NamedField> carried =
      carry(executor, job, {from.mesh, to.mesh}, chosen_fields(job, from, warnings), warnings);
  if (is_field_file(job.output)) keep_those_at_vertices(job, carried, warnings);
  const std::string said = job.verbosity > 0 ? summary(job, carried, to.mesh) : std::string();
  meshadapt::AtomicOutputs outputs;
  stage(outputs, job, to, std::move(carried), warnings);
  print_warnings(warnings, job.verbosity);
  outputs.commit();
  // From here on no memory is taken, because the output is there.
  std::fputs(said.c_str(), is_standard_output(job.output) ? stderr : stdout);
  return done;
}

int run(const Arguments& arguments) {
  const Job job = read_job(arguments);
  return run_in_team({.threads = job.threads},
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
