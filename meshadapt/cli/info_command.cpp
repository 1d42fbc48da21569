#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "command.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "extents.hpp"
#include "files.hpp"
#include "report.hpp"
#include "run_in_team.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using runtime::Executor;

constexpr std::array<Option, 3> options{{
    {"-sol", "METRIC", "measures lengths and quality in this metric (.sol, .solb)"},
    {"--json", "FILE", "writes them there, too, a .json; with - to standard output alone"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
}};

struct Validity {
  std::string reason;  ///< why the mesh cannot be adapted; empty if it can
  meshadapt::Warnings warnings;
};

/// Checks what `adapt` would check. Without a metric, `adapt` takes the sizes that the mesh has; a
/// given metric was checked when it was read.
Validity check(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  Validity validity;
  try {
    validity.warnings = meshadapt::expect_adaptable(executor, mesh);
    if (metric == nullptr) meshadapt::default_metric(executor, mesh);
    warn_of_loose_vertices(executor, mesh, validity.warnings);
    for (const std::string& crossing : meshadapt::check_boundary(executor, mesh))
      validity.warnings.push_back(mesh.name + ": " + crossing +
                                  "; what is adapted may be refused as not valid");
  } catch (const meshadapt::InputError& error) {
    validity.reason = error.in_file();
  }
  return validity;
}

/// " (steel)" after the reference, " (all+steel)" if it has two names; nothing if it has none.
std::string name_after(const AnyMesh& mesh, int dimension, std::int32_t reference) {
  std::string names;
  for (const meshadapt::ReferenceName& name : mesh.names)
    if (name.dimension == dimension && name.reference == reference)
      names += (names.empty() ? "" : "+") + meshadapt::printable(name.name);
  return names.empty() ? names : " (" + names + ")";
}

template <class References>
void print_kind(const AnyMesh& mesh, int dimension, const References& reference,
                std::size_t required) {
  constexpr std::array kinds = {"vertices", "edges", "triangles", "tetrahedra"};
  const char* const kind = kinds.at(static_cast<std::size_t>(dimension));
  if (reference.empty()) return;
  std::map<std::int32_t, std::size_t> count_of;
  for (const std::int32_t r : reference) ++count_of[r];
  std::printf("  %-12s %12s  ", kind, with_commas(reference.size()).c_str());
  if (required > 0) std::printf("%s required; ", with_commas(required).c_str());
  constexpr std::size_t shown_at_most = 12;
  std::size_t shown = 0;
  std::printf("%s", count_of.size() == 1 ? "reference" : "references");
  for (const auto& [r, count] : count_of) {
    if (shown++ == shown_at_most) {
      std::printf(", ... (%zu in all)", count_of.size());
      break;
    }
    std::printf("%s %d%s: %s", shown == 1 ? "" : ",", r, name_after(mesh, dimension, r).c_str(),
                with_commas(count).c_str());
  }
  std::printf("\n");
}

void print_counts(const AnyMesh& mesh) {
  std::printf("%s: dimension %d\n", meshadapt::printable(mesh.name).c_str(), mesh.dimension);
  print_kind(mesh, 0, mesh.vertex_reference, mesh.required_vertices.size());
  print_kind(mesh, 1, mesh.edges.reference, mesh.required_edges.size());
  print_kind(mesh, 2, mesh.triangles.reference, mesh.required_triangles.size());
  print_kind(mesh, 3, mesh.tetrahedra.reference, mesh.required_tetrahedra.size());
  if (!mesh.corners.empty())
    std::printf("  %-12s %12s\n", "corners", with_commas(mesh.corners.size()).c_str());
  if (!mesh.ridges.empty())
    std::printf("  %-12s %12s\n", "ridges", with_commas(mesh.ridges.size()).c_str());
}

/// "  area         12: reference 1 (steel) 4, 2 (air) 8".
void print_sizes(const AnyMesh& mesh, int dimension, const Extents& extents) {
  constexpr std::array words = {"", "length", "area", "volume"};
  constexpr std::size_t shown_at_most = 12;
  std::string text;
  std::size_t shown = 0;
  for (const auto& [key, size] : extents.size_of) {
    if (key.first != dimension || shown++ >= shown_at_most) continue;
    std::array<char, 64> figures;
    std::snprintf(figures.data(), figures.size(), "%.6g", size);
    text += (shown == 1 ? "reference " : ", ") + std::to_string(key.second) +
            name_after(mesh, dimension, key.second) + ": " + figures.data();
  }
  if (shown == 0) return;
  std::printf("  %-12s %12.6g  %s%s\n", words.at(static_cast<std::size_t>(dimension)),
              extents.total(dimension), text.c_str(), shown > shown_at_most ? ", ..." : "");
}

void print_extents(const AnyMesh& mesh, const Extents& extents) {
  std::printf("  %-12s", "box");
  for (std::size_t k = 0; k < static_cast<std::size_t>(mesh.dimension); ++k)
    std::printf("%s %.6g to %.6g", k == 0 ? "" : ",", extents.low[k], extents.high[k]);
  std::printf("\n");
  for (int dimension = 1; dimension <= 3; ++dimension) print_sizes(mesh, dimension, extents);
  if (extents.largest_angle > 0)
    std::printf("  %-12s %.3g to %.4g degrees%s\n", "angles", extents.smallest_angle,
                extents.largest_angle, mesh.dimension == 3 ? ", dihedral" : "");
}

std::string json_of(const Extents& extents, int dimension) {
  std::string low, high;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
    low += (k == 0 ? "" : ", ") + json_number(extents.low[k]);
    high += (k == 0 ? "" : ", ") + json_number(extents.high[k]);
  }
  return "{\"low\": [" + low + "], \"high\": [" + high +
         "], \"length\": " + json_number(extents.total(1)) +
         ", \"area\": " + json_number(extents.total(2)) +
         ", \"volume\": " + json_number(extents.total(3)) +
         ", \"smallest_angle\": " + json_number(extents.smallest_angle) +
         ", \"largest_angle\": " + json_number(extents.largest_angle) + "}";
}

/// The names of references, each with how many entities carry it, and their length, area or volume.
std::string names_json(const AnyMesh& mesh, const Extents& extents) {
  const std::array references{&mesh.vertex_reference, &mesh.edges.reference,
                              &mesh.triangles.reference, &mesh.tetrahedra.reference};
  std::map<std::pair<int, std::int32_t>, std::size_t> count_of;  // [dimension, reference]
  for (int dimension = 0; dimension <= 3 && !mesh.names.empty(); ++dimension)
    for (const std::int32_t reference : *references[static_cast<std::size_t>(dimension)])
      ++count_of[{dimension, reference}];
  const auto size_at = [&](int dimension, std::int32_t reference) {
    const auto found = extents.size_of.find({dimension, reference});
    return found == extents.size_of.end() ? 0 : found->second;
  };
  std::string text;
  for (const auto& [dimension, reference, name] : mesh.names)
    text += std::string(text.empty() ? "" : ", ") + "{\"name\": " + json_string(name) +
            ", \"dimension\": " + std::to_string(dimension) +
            ", \"reference\": " + std::to_string(reference) +
            ", \"count\": " + std::to_string(count_of[{dimension, reference}]) +
            (dimension == 0 ? "" : ", \"size\": " + json_number(size_at(dimension, reference))) +
            "}";
  return "[" + text + "]";
}

void write_json(const std::filesystem::path& path, const AnyMesh& mesh, const Validity& validity,
                const std::string& statistics) {
  const Extents extents = extents_of(mesh);
  meshadapt::AtomicOutputs outputs;
  put_json(outputs, path,
           "{\"mesh\": " + json_string(mesh.name) +
               ", \"dimension\": " + std::to_string(mesh.dimension) +
               ", \"valid\": " + (validity.reason.empty() ? "true" : "false") +
               ", \"vertices\": " + std::to_string(mesh.vertex_count()) +
               ", \"edges\": " + std::to_string(mesh.edges.size()) +
               ", \"triangles\": " + std::to_string(mesh.triangles.size()) +
               ", \"tetrahedra\": " + std::to_string(mesh.tetrahedra.size()) + ", \"extents\": " +
               json_of(extents, mesh.dimension) + ", \"names\": " + names_json(mesh, extents) +
               ", \"statistics\": " + statistics + "}\n");
  outputs.commit();
}

int work(const Executor& executor, const Arguments& arguments) {
  meshadapt::Warnings warnings;
  const AnyMesh mesh = meshadapt::read_mesh(input_of(arguments.operands()[0]), &warnings);
  std::optional<AnyField> metric;
  if (const auto path = arguments.text("-sol")) metric = read_metric(*path, mesh, warnings);
  const bool has_elements =
      !(meshadapt::element_dimension(mesh) == 2 ? mesh.triangles.reference.empty()
                                                : mesh.tetrahedra.reference.empty());
  const AnyField* const given = metric ? &*metric : nullptr;
  const auto json = json_output(arguments);
  const bool shown = json != standard_output;
  if (shown) print_counts(mesh);
  if (shown) print_extents(mesh, extents_of(mesh));
  const Validity validity = check(executor, mesh, given);
  warnings.insert(warnings.end(), validity.warnings.begin(), validity.warnings.end());
  if (shown)
    std::printf("  %s\n", validity.reason.empty() ? "valid: it can be adapted"
                                                  : ("not valid: " + validity.reason).c_str());
  std::string statistics = "null";
  if (has_elements) {
    const auto measured = meshadapt::measure(executor, mesh, given);
    if (shown) std::printf("%s", to_text(measured).c_str());
    statistics = to_json(measured);
  }
  print_warnings(warnings);
  if (json) write_json(*json, mesh, validity, statistics);
  return validity.reason.empty() ? done : misused;
}

int run(const Arguments& arguments) {
  const std::filesystem::path input = only_mesh(arguments);
  if (const auto json = arguments.text("--json"); json && *json != standard_output) {
    expect_no_input(*json, {input, arguments.text("-sol").value_or("")});
    meshadapt::check_writable(*json);
  }
  return run_in_team({.threads = arguments.integer("--threads", 1, 4096).value_or(0)},
                     [&](const Executor& executor) { return work(executor, arguments); });
}

}  // namespace

const Command info_command{
    "info",
    "MESH [-sol METRIC]",
    "counts, references, sizes, validity, edge lengths and quality of a mesh",
    "Without a metric, lengths and quality are those of plain Euclidean geometry.",
    options,
    run};

}  // namespace ductile::cli
