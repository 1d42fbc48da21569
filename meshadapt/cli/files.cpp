#include "files.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

#include "arguments.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "io/utf8.hpp"

namespace ductile::cli {

namespace fs = std::filesystem;

void print_warnings(const meshadapt::Warnings& warnings, int verbosity) {
  if (verbosity <= 0) return;
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "ductile: warning: %s\n", meshadapt::printable(warning).c_str());
}

std::optional<fs::path> metric_beside(const fs::path& mesh) {
  for (const char* ending : {".sol", ".solb"}) {
    fs::path candidate = mesh;
    candidate.replace_extension(ending);
    std::error_code ignored;
    if (candidate == mesh) continue;
    if (fs::exists(candidate, ignored)) return candidate;
    const auto left = meshadapt::left_of(candidate);
    if (!left.empty())
      throw meshadapt::InputError(
          candidate.string() + ": is not there, and a run that was ended left " +
          left.front().string() + "; rename that, or remove it to do without a metric");
  }
  return std::nullopt;
}

fs::path default_output(const fs::path& mesh) {
  fs::path output = mesh;
  const auto* const format = meshadapt::format_of(mesh);
  const bool same = format != nullptr && format->is_read && format->is_written;
  return output.replace_extension(".o" + std::string(same ? format->ending : ".mesh"));
}

fs::path field_beside(const fs::path& mesh) {
  fs::path output = mesh;
  return output.replace_extension(mesh.extension() == ".meshb" ? ".solb" : ".sol");
}

void expect_no_input(const fs::path& output, const std::vector<fs::path>& inputs) {
  std::error_code ignored;
  for (const fs::path& input : inputs)
    if (fs::equivalent(output, input, ignored))
      throw UsageError(output.string() +
                       ": is read, and would be replaced; give the output another name");
}

fs::path input_of(const std::string& word) { return word == "-" ? "/dev/stdin" : word; }

fs::path output_of(const std::string& word) { return word == "-" ? "-.mesh" : word; }

bool is_standard_output(const fs::path& output) { return output.string().starts_with("-."); }

fs::path place_of(const fs::path& output) {
  return is_standard_output(output) ? fs::path("/dev/stdout") : output;
}

void expect_mesh_name(const fs::path& path) {
  const auto* const format = meshadapt::format_of(path);
  if (format == nullptr || !format->is_written)
    throw UsageError(path.string() + ": expected a name ending in " + meshadapt::written_endings() +
                     (path.extension() == ".pos"
                          ? "; Gmsh opens a .msh with fields as views, and takes sizes from these"
                          : ""));
}

bool holds_fields(const fs::path& path) {
  const auto* const format = meshadapt::format_of(path);
  return format != nullptr && format->holds_fields;
}

bool is_at_vertices(const meshadapt::NamedField& field) {
  return field.place == meshadapt::NamedField::Place::vertices;
}

std::string names_of(const std::vector<meshadapt::NamedField>& fields) {
  std::string names;
  for (const auto& field : fields) names += (names.empty() ? "" : ", ") + field.name;
  return names;
}

namespace {

meshadapt::AnyField any_field(const meshadapt::NamedField& field, const meshadapt::AnyMesh& mesh) {
  return {mesh.dimension, mesh.vertex_count(), {field.type}, field.values, mesh.name};
}

/// All fields at vertices in one file.
meshadapt::AnyField fields_in(const fs::path& path, meshadapt::Warnings& warnings) {
  if (!holds_fields(path)) return meshadapt::read_field(path, &warnings);
  auto file = meshadapt::read_mesh_with_fields(path, &warnings);
  std::erase_if(file.fields, [](const auto& field) { return !is_at_vertices(field); });
  if (file.fields.empty())
    throw meshadapt::InputError(path.string() + ": expected fields at vertices, found none");
  return side_by_side(file.fields, file.mesh);
}

/// The number of entities of a mesh that a field has values for.
std::size_t entity_count(const meshadapt::AnyMesh& mesh, meshadapt::NamedField::Place place) {
  if (place == meshadapt::NamedField::Place::vertices) return mesh.vertex_count();
  return meshadapt::element_dimension(mesh) == 2 ? mesh.triangles.size() : mesh.tetrahedra.size();
}

/// Moves a size or a metric from elements to vertices: the mean of the logarithms around each.
template <int Dim>
meshadapt::AnyField mean_at_vertices(const meshadapt::NamedField& field,
                                     const meshadapt::AnyMesh& mesh) {
  using meshadapt::Metric;
  const auto& elements = meshadapt::elements_in<Dim>(mesh);
  meshadapt::AnyMesh places;  // as many as elements
  places.dimension = Dim;
  places.dropped_axis = mesh.dropped_axis;
  places.vertex_reference.assign(elements.size(), 0);
  places.coordinates.assign(elements.size() * Dim, 0);
  const auto metric = meshadapt::metric_of(
      {Dim, elements.size(), {field.type}, field.values, mesh.name + ", on elements"}, places);
  std::vector<Metric<Dim>> sum(mesh.vertex_count());
  std::vector<double> count(mesh.vertex_count());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Metric<Dim> on_element;
    std::copy_n(&metric.values[e * on_element.m.size()], on_element.m.size(), on_element.m.begin());
    const Metric<Dim> log = meshadapt::logarithm(on_element);
    for (const std::uint32_t v : elements.vertices[e]) {
      sum[v] += log;
      ++count[v];
    }
  }
  meshadapt::AnyField result{Dim, sum.size(), metric.types, {}, mesh.name};
  for (std::size_t v = 0; v < sum.size(); ++v) {
    const Metric<Dim> mean = meshadapt::exponential(1 / std::max(count[v], 1.0) * sum[v]);
    result.values.insert(result.values.end(), mean.m.begin(), mean.m.end());
  }
  return result;
}

/// A metric at the vertices, which may be given there or on elements.
meshadapt::AnyField metric_at_vertices(const meshadapt::NamedField& field,
                                       const meshadapt::AnyMesh& mesh) {
  if (is_at_vertices(field)) return any_field(field, mesh);
  return mesh.dimension == 2 ? mean_at_vertices<2>(field, mesh) : mean_at_vertices<3>(field, mesh);
}

meshadapt::AnyField metric_of_file(const fs::path& path, meshadapt::Warnings& warnings) {
  if (!holds_fields(path)) return meshadapt::read_field(path, &warnings, {.infinite = true});
  const auto file = meshadapt::read_mesh_with_fields(path, &warnings);
  if (const auto metric = metric_in(file)) return *metric;
  const auto at = std::find_if(file.fields.begin(), file.fields.end(), is_at_vertices);
  const auto count = std::count_if(file.fields.begin(), file.fields.end(), is_at_vertices);
  if (count == 1) return any_field(*at, file.mesh);
  if (count == 0 && file.fields.size() == 1) return metric_at_vertices(file.fields[0], file.mesh);
  throw meshadapt::InputError(path.string() + ": expected a field 'metric', or one alone, found " +
                              (file.fields.empty() ? "none" : names_of(file.fields)) +
                              "; rename the metric");
}

}  // namespace

std::optional<meshadapt::AnyField> metric_in(const meshadapt::MeshWithFields& file) {
  for (const auto place :
       {meshadapt::NamedField::Place::vertices, meshadapt::NamedField::Place::elements})
    for (const auto& field : file.fields)
      if (field.place == place && field.name == "metric")
        return metric_at_vertices(field, file.mesh);
  return std::nullopt;
}

meshadapt::AnyField read_metric(const fs::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings,
                                const meshadapt::SizeBounds& bounds) {
  return meshadapt::metric_of(metric_of_file(path, warnings), mesh, bounds);
}

meshadapt::AnyField read_fields(const fs::path& path, const meshadapt::AnyMesh& mesh,
                                meshadapt::Warnings& warnings) {
  using Type = meshadapt::AnyField::Type;
  meshadapt::AnyField field = fields_in(path, warnings);
  if (std::all_of(field.types.begin(), field.types.end(), [](Type t) { return t == Type::scalar; }))
    field.dimension = mesh.dimension;  // which may be 2 in a file of dimension 3 that is flat
  meshadapt::expect_field_of(field, mesh);
  return field;
}

meshadapt::AnyField side_by_side(const std::vector<meshadapt::NamedField>& fields,
                                 const meshadapt::AnyMesh& mesh) {
  meshadapt::AnyField all = any_field(fields.at(0), mesh);
  for (std::size_t i = 1; i < fields.size(); ++i)
    all = meshadapt::joined(all, any_field(fields[i], mesh));
  return all;
}

std::vector<meshadapt::NamedField> read_named_fields(const fs::path& path,
                                                     const meshadapt::AnyMesh& mesh,
                                                     meshadapt::Warnings& warnings) {
  if (!holds_fields(path))
    return meshadapt::named_fields(read_fields(path, mesh, warnings),
                                   as_utf8(path.stem().string()));
  auto file = meshadapt::read_mesh_with_fields(path, &warnings);
  if (file.mesh.dimension != mesh.dimension)
    throw meshadapt::InputError(path.string() + ": expected fields of dimension " +
                                std::to_string(mesh.dimension) + ", that of " + mesh.name +
                                ", found " + std::to_string(file.mesh.dimension) +
                                "; give fields of this mesh");
  for (const auto& field : file.fields) {
    const std::size_t expected = entity_count(mesh, field.place),
                      found = entity_count(file.mesh, field.place);
    if (found != expected)
      throw meshadapt::InputError(
          path.string() + ": expected " + std::to_string(expected) + " values in '" + field.name +
          "', one for each " + (is_at_vertices(field) ? "vertex" : "element") + " of " + mesh.name +
          ", found " + std::to_string(found) + "; give fields of this mesh");
  }
  return std::move(file.fields);
}

namespace {

/// The fields at vertices, without a metric beside others.
std::vector<meshadapt::NamedField> solutions_among(std::vector<meshadapt::NamedField> fields,
                                                   const std::string& source) {
  std::erase_if(fields, [](const auto& field) { return !is_at_vertices(field); });
  if (fields.empty())
    throw meshadapt::InputError(source + ": expected fields at vertices, found none");
  if (fields.size() > 1) std::erase_if(fields, [](const auto& f) { return f.name == "metric"; });
  return fields;
}

bool has_field(const meshadapt::MeshWithFields& mesh, const std::string& name) {
  return std::any_of(mesh.fields.begin(), mesh.fields.end(),
                     [&](const auto& field) { return field.name == name; });
}

/// The field of this name. Throws InputError if there is none.
const meshadapt::NamedField& field_called(const std::string& name,
                                          const std::vector<meshadapt::NamedField>& fields,
                                          const std::string& source) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const auto& field) { return field.name == name; });
  if (found == fields.end())
    throw meshadapt::InputError(source + ": expected a field '" + name +
                                "' at its vertices, found " + names_of(fields) +
                                "; give one of these, or a file that is there");
  return *found;
}

}  // namespace

std::vector<meshadapt::NamedField> read_solutions(const fs::path& path,
                                                  const meshadapt::AnyMesh& mesh,
                                                  meshadapt::Warnings& warnings) {
  auto fields = read_named_fields(path, mesh, warnings);
  if (!holds_fields(path)) return fields;
  fields = solutions_among(std::move(fields), path.string());
  if (fields[0].name == "metric") fields[0].name = as_utf8(path.stem().string());
  return fields;
}

bool is_file(const std::string& word) {
  std::error_code ignored;
  const fs::path path = word;
  return path.extension() == ".sol" || path.extension() == ".solb" || holds_fields(path) ||
         fs::exists(path, ignored);
}

std::vector<meshadapt::NamedField> chosen_solutions(const std::vector<std::string>& words,
                                                    const meshadapt::MeshWithFields& mesh,
                                                    meshadapt::Warnings& warnings) {
  const bool from_file = is_file(words.at(0)) && !has_field(mesh, words[0]);
  const std::string source = from_file ? words[0] : mesh.mesh.name;
  auto fields = from_file ? read_solutions(words[0], mesh.mesh, warnings)
                          : solutions_among(mesh.fields, source);
  const std::vector<std::string> names(words.begin() + (from_file ? 1 : 0), words.end());
  if (names.empty() && fields.size() > 1 && from_file && !holds_fields(words[0]))
    warnings.push_back(source + ": the metric is made of all its fields, " + names_of(fields) +
                       "; name one of them to make it of that alone");
  else if (names.empty() && fields.size() > 1)
    throw meshadapt::InputError(
        source + ": expected the name of a field after it, because it has " +
        std::to_string(fields.size()) + ": " + names_of(fields) + "; name one of them, or several");
  std::vector<meshadapt::NamedField> chosen;
  chosen.reserve(names.size());
  for (const std::string& name : names) chosen.push_back(field_called(name, fields, source));
  return names.empty() ? fields : chosen;
}

void warn_of_loose_vertices(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                            meshadapt::Warnings& warnings) {
  for (const std::string& loose : meshadapt::check_conformity(executor, mesh))
    warnings.push_back(
        mesh.name + ": " + loose + "; the mesh is not connected there" +
        (loose.find(" hangs: ") == std::string::npos ? " (--join X joins them)" : ""));
}

std::optional<double> join_option(const Arguments& arguments) {
  const auto distance = arguments.number("--join");
  if (distance && !(*distance >= 0 && *distance <= meshadapt::largest_size))
    refuse_value("--join", "a distance of 0 or more", *arguments.text("--join"));
  return distance;
}

std::vector<std::uint32_t> join(meshadapt::AnyMesh& mesh, double distance,
                                meshadapt::Warnings& warnings) {
  const std::size_t before = mesh.vertex_count();
  auto joined = meshadapt::join_vertices(std::move(mesh), distance);
  mesh = std::move(joined.mesh);
  warnings.push_back(mesh.name + ": " +
                     counted(before - joined.kept.size(), "vertex was", "vertices were") +
                     " joined with others");
  return std::move(joined.kept);
}

void keep_at(const std::vector<std::uint32_t>& kept, std::vector<meshadapt::NamedField>& fields,
             int dimension) {
  for (meshadapt::NamedField& field : fields) {
    if (!is_at_vertices(field)) continue;
    const auto rows = static_cast<std::size_t>(component_count(field.type, dimension));
    field.values =
        meshadapt::at_kept({dimension, field.values.size() / rows, {field.type}, field.values, {}},
                           kept)
            .values;
  }
}

fs::path only_mesh(const Arguments& arguments, const char* hint) {
  std::vector<std::string> meshes = arguments.operands();
  if (const auto mesh = arguments.text("-in")) meshes.push_back(*mesh);
  if (meshes.size() != 1)
    throw UsageError("expected one mesh, found " + std::to_string(meshes.size()) +
                     (meshes.size() == 2 ? hint : ""));
  return input_of(meshes[0]);
}

std::optional<fs::path> json_output(const Arguments& arguments) {
  const auto place = arguments.text("--json");
  return place ? std::optional<fs::path>(*place) : std::nullopt;
}

void put_json(meshadapt::AtomicOutputs& outputs, const fs::path& place, const std::string& json) {
  if (place == standard_output)
    std::fputs(json.c_str(), stdout);
  else
    meshadapt::write_bytes(outputs, place, json);
}

std::string as_utf8(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = meshadapt::utf8_length(text, at);
    result += length > 0 ? text.substr(at, length) : "?";
    at += std::max<std::size_t>(length, 1);
  }
  return result;
}

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return with_commas(number) + " " + (number == 1 ? one : many);
}

}  // namespace ductile::cli
