#include "files.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "mesh/array_lengths.hpp"

namespace ductile::cli {

void print_warnings(const Warnings& warnings, int verbosity) {
  if (verbosity <= 0) return;
  for (const std::string& warning : warnings)
    std::fprintf(stderr, "ductile: warning: %s\n", printable(warning).c_str());
}

std::optional<fs::path> metric_beside(const fs::path& mesh) {
  for (const char* ending : {".sol", ".solb"}) {
    fs::path candidate = mesh;
    candidate.replace_extension(ending);
    std::error_code ignored;
    if (candidate == mesh) continue;
    if (fs::exists(candidate, ignored)) return candidate;
    const auto left = left_of(candidate);
    if (!left.empty())
      throw InputError(candidate.string() + ": is not there, and a run that was ended left " +
                       left.front().string() +
                       "; rename that, or remove it to do without a metric");
  }
  return std::nullopt;
}

fs::path default_output(const fs::path& mesh) {
  fs::path output = mesh;
  const auto* const format = format_of(mesh);
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
  const auto* const format = format_of(path);
  if (format == nullptr || !format->is_written)
    throw UsageError(path.string() + ": expected a name ending in " + written_endings() +
                     (path.extension() == ".pos"
                          ? "; Gmsh opens a .msh with fields as views, and takes sizes from these"
                          : ""));
}

bool holds_fields(const fs::path& path) {
  const auto* const format = format_of(path);
  return format != nullptr && format->holds_fields;
}

bool holds_field(const fs::path& path) {
  return path.extension() == ".sol" || path.extension() == ".solb";
}

void expect_fields_held(const fs::path& path) {
  if (!holds_field(path) && !holds_fields(path))
    throw UsageError(
        "option -o: expected a name ending in .sol or .solb, or of a format that holds a mesh and "
        "fields, found '" +
        path.string() + "'");
}

// ---- Fields ----

bool is_at_vertices(const NamedField& field) { return field.place == NamedField::Place::vertices; }

std::string names_of(const std::vector<NamedField>& fields) {
  return listed(fields, &NamedField::name);
}

std::vector<NamedField> at_vertices(std::vector<NamedField> fields, const std::string& source) {
  std::erase_if(fields, [](const auto& field) { return !is_at_vertices(field); });
  if (fields.empty()) throw InputError(source + ": expected fields at vertices, found none");
  return fields;
}

namespace {

AnyField any_field(const NamedField& field, const AnyMesh& mesh) {
  return {mesh.dimension, mesh.vertex_count(), {field.type}, field.values, mesh.name};
}

/// The number of entities of a mesh that a field has values for.
std::size_t entity_count(const AnyMesh& mesh, const NamedField& field) {
  return is_at_vertices(field) ? mesh.vertex_count() : element_count(mesh);
}

/// Moves a size or a metric from elements to vertices: the mean of the logarithms around each.
template <int Dim>
AnyField mean_at_vertices(const NamedField& field, const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh);
  AnyMesh places;  // as many as elements
  places.dimension = Dim;
  places.dropped_axis = mesh.dropped_axis;
  places.vertex_reference.assign(elements.size(), 0);
  places.coordinates.assign(elements.size() * Dim, 0);
  const auto metric = metric_of(
      {Dim, elements.size(), {field.type}, field.values, mesh.name + ", on elements"}, places);
  std::vector<Metric<Dim>> sum(mesh.vertex_count());
  std::vector<double> count(mesh.vertex_count());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Metric<Dim> on_element;
    std::copy_n(&metric.values[e * on_element.m.size()], on_element.m.size(), on_element.m.begin());
    const Metric<Dim> log = logarithm(on_element);
    for (const std::uint32_t v : elements.vertices[e]) {
      sum[v] += log;
      ++count[v];
    }
  }
  AnyField result{Dim, sum.size(), metric.types, {}, mesh.name};
  for (std::size_t v = 0; v < sum.size(); ++v) {
    const Metric<Dim> mean = exponential(1 / std::max(count[v], 1.0) * sum[v]);
    result.values.insert(result.values.end(), mean.m.begin(), mean.m.end());
  }
  return result;
}

/// A metric at the vertices, which may be given there or on elements.
AnyField metric_at_vertices(const NamedField& field, const AnyMesh& mesh) {
  if (is_at_vertices(field)) return any_field(field, mesh);
  return mesh.dimension == 2 ? mean_at_vertices<2>(field, mesh) : mean_at_vertices<3>(field, mesh);
}

AnyField metric_of_file(const fs::path& path, Warnings& warnings) {
  if (!holds_fields(path)) return read_field(path, &warnings, {.infinite = true});
  const auto file = read_mesh_with_fields(path, &warnings);
  if (const auto metric = metric_in(file)) return *metric;
  const auto at = std::find_if(file.fields.begin(), file.fields.end(), is_at_vertices);
  const auto count = std::count_if(file.fields.begin(), file.fields.end(), is_at_vertices);
  if (count == 1) return any_field(*at, file.mesh);
  if (count == 0 && file.fields.size() == 1) return metric_at_vertices(file.fields[0], file.mesh);
  throw InputError(path.string() + ": expected a field 'metric', or one alone, found " +
                   (file.fields.empty() ? "none" : names_of(file.fields)) + "; rename the metric");
}

}  // namespace

std::optional<AnyField> metric_in(const MeshWithFields& file) {
  for (const auto place : {NamedField::Place::vertices, NamedField::Place::elements})
    for (const auto& field : file.fields)
      if (field.place == place && field.name == "metric")
        return metric_at_vertices(field, file.mesh);
  return std::nullopt;
}

AnyField read_metric(const fs::path& path, const AnyMesh& mesh, Warnings& warnings,
                     const SizeBounds& bounds) {
  return metric_of(metric_of_file(path, warnings), mesh, bounds);
}

AnyField side_by_side(const std::vector<NamedField>& fields, const AnyMesh& mesh) {
  AnyField all = any_field(fields.at(0), mesh);
  for (std::size_t i = 1; i < fields.size(); ++i) all = joined(all, any_field(fields[i], mesh));
  return all;
}

std::vector<NamedField> read_named_fields(const fs::path& path, const AnyMesh& mesh,
                                          Warnings& warnings) {
  using Type = AnyField::Type;
  if (!holds_fields(path)) {
    AnyField field = read_field(path, &warnings);
    if (std::ranges::all_of(field.types, [](Type type) { return type == Type::scalar; }))
      field.dimension = mesh.dimension;  // which may be 2 in a file of dimension 3 that is flat
    expect_field_of(field, mesh);
    return named_fields(field, as_utf8(path.stem().string()));
  }
  auto file = read_mesh_with_fields(path, &warnings);
  if (file.mesh.dimension != mesh.dimension)
    throw InputError(path.string() + ": expected fields of dimension " +
                     std::to_string(mesh.dimension) + ", that of " + mesh.name + ", found " +
                     std::to_string(file.mesh.dimension) + "; give fields of this mesh");
  for (const auto& field : file.fields) {
    const std::size_t expected = entity_count(mesh, field), found = entity_count(file.mesh, field);
    if (found != expected)
      throw InputError(path.string() + ": expected " + std::to_string(expected) + " values in '" +
                       field.name + "', one for each " +
                       (is_at_vertices(field) ? "vertex" : "element") + " of " + mesh.name +
                       ", found " + std::to_string(found) + "; give fields of this mesh");
  }
  return std::move(file.fields);
}

namespace {

/// The fields at vertices, without a metric beside others.
std::vector<NamedField> solutions_among(std::vector<NamedField> fields, const std::string& source) {
  fields = at_vertices(std::move(fields), source);
  if (fields.size() > 1) std::erase_if(fields, [](const auto& f) { return f.name == "metric"; });
  return fields;
}

auto field_called(const std::string& name, const std::vector<NamedField>& fields) {
  return std::ranges::find(fields, name, &NamedField::name);
}

}  // namespace

std::vector<NamedField> read_solutions(const fs::path& path, const AnyMesh& mesh,
                                       Warnings& warnings) {
  auto fields = read_named_fields(path, mesh, warnings);
  if (!holds_fields(path)) return fields;
  fields = solutions_among(std::move(fields), path.string());
  if (fields[0].name == "metric") fields[0].name = as_utf8(path.stem().string());
  return fields;
}

bool is_file(const std::string& word) {
  std::error_code ignored;
  return holds_field(word) || holds_fields(word) || fs::exists(word, ignored);
}

std::vector<NamedField> chosen_solutions(const std::vector<std::string>& words,
                                         const MeshWithFields& mesh, Warnings& warnings) {
  const bool from_file =
      is_file(words.at(0)) && field_called(words[0], mesh.fields) == mesh.fields.end();
  const std::string source = from_file ? words[0] : mesh.mesh.name;
  auto fields = from_file ? read_solutions(words[0], mesh.mesh, warnings)
                          : solutions_among(mesh.fields, source);
  std::vector<NamedField> chosen;
  for (std::size_t i = from_file ? 1 : 0; i < words.size(); ++i) {
    const auto found = field_called(words[i], fields);
    if (found == fields.end())
      throw InputError(source + ": expected a field '" + words[i] + "' at its vertices, found " +
                       names_of(fields) + "; give one of these, or a file that is there");
    chosen.push_back(*found);
  }
  if (!chosen.empty()) return chosen;
  if (fields.size() > 1 && from_file && !holds_fields(words[0]))
    warnings.push_back(source + ": the metric is made of all its fields, " + names_of(fields) +
                       "; name one of them to make it of that alone");
  else if (fields.size() > 1)
    throw InputError(source + ": expected the name of a field after it, because it has " +
                     std::to_string(fields.size()) + ": " + names_of(fields) +
                     "; name one of them, or several");
  return fields;
}

// ---- Other options ----

void warn_of_loose_vertices(const runtime::Executor& executor, const AnyMesh& mesh,
                            Warnings& warnings) {
  for (const std::string& loose : check_conformity(executor, mesh))
    warnings.push_back(
        mesh.name + ": " + loose + "; the mesh is not connected there" +
        (loose.find(" hangs: ") == std::string::npos ? " (--join X joins them)" : ""));
}

std::optional<double> join_option(const Arguments& arguments) {
  const auto distance = arguments.number("--join");
  if (distance && !(*distance >= 0 && *distance <= largest_size))
    refuse_value("--join", "a distance of 0 or more", *arguments.text("--join"));
  return distance;
}

std::vector<std::uint32_t> join(AnyMesh& mesh, double distance, Warnings& warnings) {
  const std::size_t before = mesh.vertex_count();
  auto joined = join_vertices(std::move(mesh), distance);
  mesh = std::move(joined.mesh);
  warnings.push_back(mesh.name + ": " +
                     counted(before - joined.kept.size(), "vertex was", "vertices were") +
                     " joined with others");
  return std::move(joined.kept);
}

void keep_at(const std::vector<std::uint32_t>& kept, std::vector<NamedField>& fields,
             int dimension) {
  for (NamedField& field : fields) {
    if (!is_at_vertices(field)) continue;
    const auto rows = static_cast<std::size_t>(component_count(field.type, dimension));
    field.values =
        at_kept({dimension, field.values.size() / rows, {field.type}, field.values, {}}, kept)
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

void put_json(AtomicOutputs& outputs, const fs::path& place, const std::string& json) {
  if (place == standard_output)
    std::fputs(json.c_str(), stdout);
  else
    write_bytes(outputs, place, json);
}

}  // namespace ductile::cli
