#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "command.hpp"
#include "ductile/meshadapt/fields.hpp"
#include "ductile/meshadapt/gmf.hpp"
#include "ductile/meshadapt/make_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/vtu.hpp"
#include "files.hpp"

namespace ductile::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::array<Option, 2> options{{
    {"-sol", "FIELD", "for .vtu: the field at the vertices to take along"},
    {"--version-of-file", "N",
     "GMF version to write, 1 to 4 (default: 2, more if the size needs it)"},
}};

/// Version 1 has numbers of 4 bytes in binary: what is rounded may move vertices onto each other.
void warn_of_rounding(const std::vector<double>& values, const fs::path& to, int version,
                      meshadapt::Warnings& warnings) {
  const std::string ending = to.extension().string();
  if (version != 1 || !ending.ends_with('b')) return;
  const auto rounded = std::count_if(values.begin(), values.end(), [](double value) {
    return static_cast<double>(static_cast<float>(value)) != value;
  });
  if (rounded > 0)
    warnings.push_back(to.string() + ": version 1 holds 7 digits; " + std::to_string(rounded) +
                       " numbers were rounded (--version-of-file 2 keeps them)");
}

bool rounds(const fs::path& to, const meshadapt::GmfOptions& form) {
  return form.version == 1 && to.extension().string().ends_with('b');
}

std::vector<double> rounded(std::vector<double> values) {
  for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  return values;
}

/// Calls a check; true unless it refuses.
template <class Check>
bool passes(Check&& check) {
  try {
    check();
  } catch (const meshadapt::InputError&) {
    return false;
  }
  return true;
}

/// What could be adapted, or adapted to, before it is rounded shall be so when it is read again.
template <class Check, class Rounded>
void expect_to_stay(const char* what, const fs::path& to, Check&& check, Rounded&& rounded_of) {
  if (!passes([&] { check(rounded_of(false)); }) || passes([&] { check(rounded_of(true)); }))
    return;
  throw meshadapt::InputError(to.string() +
                              ": version 1 holds 7 digits, and rounded to those it is" +
                              " no valid " + what + " any more; --version-of-file 2 keeps them");
}

template <int Dim>
void make_any_mesh(const meshadapt::AnyMesh& mesh) {
  meshadapt::Neighbours<Dim> neighbours;
  meshadapt::Warnings ignored;
  meshadapt::make_mesh<Dim>(runtime::Executor({.threads = 1}), mesh, {.complete_boundary = true},
                            neighbours, ignored);
}

void expect_mesh_to_stay(meshadapt::AnyMesh mesh, const fs::path& to) {
  const std::vector<double> exact = mesh.coordinates;
  expect_to_stay(
      "mesh", to,
      [](const meshadapt::AnyMesh& any) {
        any.dimension == 2 ? make_any_mesh<2>(any) : make_any_mesh<3>(any);
      },
      [&](bool round) -> const meshadapt::AnyMesh& {
        mesh.coordinates = round ? rounded(exact) : exact;
        return mesh;
      });
}

void expect_metric_to_stay(meshadapt::AnyField field, const fs::path& to) {
  meshadapt::AnyMesh any;  // only to have as many vertices
  any.dimension = field.dimension;
  any.vertex_reference.assign(field.vertex_count, 0);
  any.coordinates.assign(field.vertex_count * static_cast<std::size_t>(field.dimension), 0);
  const std::vector<double> exact = field.values;
  expect_to_stay(
      "metric", to, [&](const meshadapt::AnyField& metric) { meshadapt::metric_of(metric, any); },
      [&](bool round) -> const meshadapt::AnyField& {
        field.values = round ? rounded(exact) : exact;
        return field;
      });
}

bool holds_field(const fs::path& path) {
  return path.extension() == ".sol" || path.extension() == ".solb";
}
bool holds_mesh(const fs::path& path) {
  return path.extension() == ".mesh" || path.extension() == ".meshb";
}

void convert_mesh(const fs::path& from, const fs::path& to, const Arguments& arguments,
                  const meshadapt::GmfOptions& form, meshadapt::Warnings& warnings) {
  const meshadapt::AnyMesh mesh = meshadapt::read_mesh(from, &warnings);
  if (holds_mesh(to)) {
    if (rounds(to, form)) expect_mesh_to_stay(mesh, to);
    warn_of_rounding(mesh.coordinates, to, form.version, warnings);
    return meshadapt::write_mesh(to, mesh, form);
  }
  std::vector<meshadapt::NamedField> fields;
  if (const auto path = arguments.text("-sol"))
    fields = meshadapt::named_fields(read_fields(*path, mesh, warnings),
                                     as_utf8(fs::path(*path).stem().string()));
  meshadapt::write_vtu(to, mesh, fields);
}

int run(const Arguments& arguments) {
  if (arguments.operands().size() != 2)
    throw UsageError("expected an input and an output, found " +
                     std::to_string(arguments.operands().size()) + " files");
  const fs::path from = arguments.operands()[0], to = arguments.operands()[1];
  const bool field = holds_field(from);
  if (field ? !holds_field(to) : !holds_mesh(to) && to.extension() != ".vtu")
    throw UsageError(to.string() + ": expected a name ending in " +
                     (field ? ".sol or .solb, as the input is a field"
                            : ".mesh, .meshb or .vtu, as the input is a mesh"));
  const bool for_paraview = to.extension() == ".vtu";
  if (!for_paraview && arguments.has("-sol"))
    throw UsageError("option -sol: expected an output .vtu, found " + to.string() +
                     "; convert the field by itself");
  if (for_paraview && arguments.has("--version-of-file"))
    throw UsageError("option --version-of-file: " + to.string() + " takes none");
  const meshadapt::GmfOptions form{.version =
                                       arguments.integer("--version-of-file", 1, 4).value_or(0)};
  meshadapt::check_writable(to);
  meshadapt::Warnings warnings;
  if (field) {
    const meshadapt::AnyField values = meshadapt::read_field(from, &warnings);
    if (rounds(to, form)) expect_metric_to_stay(values, to);
    warn_of_rounding(values.values, to, form.version, warnings);
    meshadapt::write_field(to, values, form);
  } else
    convert_mesh(from, to, arguments, form, warnings);
  print_warnings(warnings);
  return done;
}

}  // namespace

const Command convert_command{
    "convert",
    "IN OUT [-sol FIELD]",
    "writes a mesh or a field in another format",
    "Meshes: .mesh, .meshb (read and written), .vtu (written). Fields: .sol, .solb.",
    options,
    run};

}  // namespace ductile::cli
