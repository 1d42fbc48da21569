#include <array>
#include <filesystem>
#include <string>
#include <utility>

#include "command.hpp"
#include "ductile/meshadapt/files.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

constexpr std::array<Option, 4> options{{
    {"-sol", "FIELD", "for formats that hold fields: those at the vertices to take along"},
    {"--version-of-file", "N",
     "GMF: 1 (text) to 4 (default: 2, or what the size needs); .msh: 2 for 2.2, or 4 for 4.1"},
    {"--binary", "", "for .msh and .vtk: bytes instead of text"},
    {"--join", "X", "makes one of vertices that are at most X from each other; 0: at one place"},
}};

bool is_gmf(const fs::path& path) {
  return holds_field(path) || path.extension() == ".mesh" || path.extension() == ".meshb";
}

void warn_of_fields(const MeshWithFields& file, const fs::path& to, Warnings& warnings) {
  if (!file.fields.empty())
    warnings.push_back(to.string() + ": holds no fields, those of " + file.mesh.name +
                       " are left out: " + names_of(file.fields) +
                       "; convert to a .sol for those at vertices");
}

void convert_mesh(const fs::path& from, const fs::path& to, const Arguments& arguments,
                  WriteOptions form, Warnings& warnings) {
  MeshWithFields file = read_mesh_with_fields(from, &warnings);
  if (const auto path = arguments.text("-sol"))
    for (auto& field : at_vertices(read_named_fields(*path, file.mesh, warnings), *path))
      file.fields.push_back(std::move(field));
  if (const auto distance = join_option(arguments))
    keep_at(join(file.mesh, *distance, warnings), file.fields, file.mesh.dimension);
  if (holds_fields(to))
    form.fields = file.fields;
  else
    warn_of_fields(file, to, warnings);
  const std::string ending = to.extension().string();
  form.format = ending;
  write_mesh(place_of(to), file.mesh, form);
}

/// Throws UsageError unless the output can hold the input: a field goes to a field, a mesh to a
/// mesh, and fields of a mesh to a field.
void expect_names(const fs::path& from, const fs::path& to) {
  if (holds_field(to) && (holds_field(from) || holds_fields(from))) return;
  if (holds_field(from))
    throw UsageError(to.string() +
                     ": expected a name ending in .sol or .solb, as the input is a field");
  if (holds_field(to))
    throw UsageError(to.string() + ": expected a name ending in " + written_endings() +
                     ", as the input is a mesh");
  expect_mesh_name(to);
}

WriteOptions form_of(const Arguments& arguments, const fs::path& to) {
  WriteOptions form;
  form.version = arguments.integer("--version-of-file", 1, 4).value_or(0);
  const bool is_msh = to.extension() == ".msh", is_vtk = to.extension() == ".vtk";
  if (form.version != 0 && !is_gmf(to) && !is_msh)
    throw UsageError("option --version-of-file: " + to.string() + " takes none");
  if (form.version == 1 && to.extension().string().ends_with('b'))
    throw UsageError("option --version-of-file: binary files of version 1 hold 7 digits; take 2");
  if (is_msh && form.version % 2 != 0)
    throw UsageError("option --version-of-file: " + to.string() + " takes 2 or 4");
  if (holds_field(to))
    form.form = to.extension() == ".sol" ? WriteOptions::Form::ascii : WriteOptions::Form::binary;
  if (!arguments.has("--binary")) return form;
  if (!is_msh && !is_vtk)
    throw UsageError("option --binary: expected an output .msh or .vtk, found " + to.string());
  form.form = WriteOptions::Form::binary;
  return form;
}

int run(const Arguments& arguments) {
  if (arguments.operands().size() != 2)
    throw UsageError("expected an input and an output, found " +
                     std::to_string(arguments.operands().size()) + " files");
  const fs::path from = input_of(arguments.operands()[0]), to = output_of(arguments.operands()[1]);
  expect_names(from, to);
  if (!holds_fields(to) && arguments.has("-sol"))
    throw UsageError("option -sol: expected an output that holds fields, such as .vtu, found " +
                     to.string() + "; convert the field by itself");
  if (holds_field(to) && join_option(arguments))
    throw UsageError("option --join: expected an output that is a mesh, found " + to.string());
  WriteOptions form = form_of(arguments, to);
  check_writable(place_of(to));
  Warnings warnings;
  form.warnings = &warnings;
  if (holds_field(from)) {
    write_field(place_of(to), read_field(from, &warnings), form);
  } else if (holds_field(to)) {
    MeshWithFields file = read_mesh_with_fields(from, &warnings);
    const auto fields = at_vertices(std::move(file.fields), from.string());
    write_field(place_of(to), side_by_side(fields, file.mesh), form);
  } else {
    convert_mesh(from, to, arguments, form, warnings);
  }
  print_warnings(warnings);
  return done;
}

}  // namespace

const Command convert_command{
    "convert",
    "IN OUT [-sol FIELD] [--join X]",
    "writes a mesh or a field in another format",
    "Meshes in the formats that ductile help lists. Fields: .sol, .solb, to which those at the\n"
    "vertices can be written, too, of a mesh whose format holds fields.",
    options,
    run};

}  // namespace ductile::cli
