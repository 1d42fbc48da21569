#include <array>
#include <cstdio>
#include <string>

#include "command.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/files.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "extents.hpp"
#include "files.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/names.hpp"

namespace ductile::cli {

namespace {

using runtime::Executor;

constexpr std::array<Option, 3> options{{
    {"-sol", "METRIC", "measures lengths and quality in this metric (.sol, .solb)"},
    {"--json", "FILE", "writes them there, too, a .json; with - to standard output alone"},
    {"--threads", "N", "threads to use (default: the cores this process may use)"},
}};

struct Validity {
  std::string reason;  ///< why the mesh cannot be adapted; empty if it can
  Warnings warnings;
};

/// Checks what `adapt` would check. Without a metric, `adapt` takes the sizes that the mesh has; a
/// given metric was checked when it was read.
Validity check(const Executor& executor, const AnyMesh& mesh, const AnyField* metric) {
  Validity validity;
  try {
    validity.warnings = expect_adaptable(executor, mesh);
    if (metric == nullptr) default_metric(executor, mesh);
    warn_of_loose_vertices(executor, mesh, validity.warnings);
    for (const std::string& crossing : check_boundary(executor, mesh))
      validity.warnings.push_back(mesh.name + ": " + crossing +
                                  "; what is adapted may be refused as not valid");
  } catch (const InputError& error) {
    validity.reason = error.in_file();
  }
  return validity;
}

/// " (steel)" after the reference, " (all+steel)" if it has two names; nothing if it has none.
std::string name_after(const AnyMesh& mesh, std::size_t dimension, std::int32_t reference) {
  const std::string names = joined_names(mesh, static_cast<int>(dimension), reference);
  return names.empty() ? names : " (" + printable(names) + ")";
}

constexpr std::size_t shown_at_most = 12;

void print_kind(const AnyMesh& mesh, const Extents& extents, std::size_t dimension,
                std::size_t required) {
  constexpr std::array kinds = {"vertices", "edges", "triangles", "tetrahedra"};
  const auto& amount_of = extents.amount_of.at(dimension);
  if (amount_of.empty()) return;
  std::printf("  %-12s %12s  ", kinds.at(dimension),
              with_commas(extents.total(dimension).count).c_str());
  if (required > 0) std::printf("%s required; ", with_commas(required).c_str());
  std::size_t shown = 0;
  std::printf("%s", amount_of.size() == 1 ? "reference" : "references");
  for (const auto& [reference, amount] : amount_of) {
    if (shown++ == shown_at_most) {
      std::printf(", ... (%zu in all)", amount_of.size());
      break;
    }
    std::printf("%s %d%s: %s", shown == 1 ? "" : ",", reference,
                name_after(mesh, dimension, reference).c_str(), with_commas(amount.count).c_str());
  }
  std::printf("\n");
}

void print_counts(const AnyMesh& mesh, const Extents& extents) {
  std::printf("%s: dimension %d\n", printable(mesh.name).c_str(), mesh.dimension);
  print_kind(mesh, extents, 0, mesh.required_vertices.size());
  print_kind(mesh, extents, 1, mesh.required_edges.size());
  print_kind(mesh, extents, 2, mesh.required_triangles.size());
  print_kind(mesh, extents, 3, mesh.required_tetrahedra.size());
  if (!mesh.corners.empty())
    std::printf("  %-12s %12s\n", "corners", with_commas(mesh.corners.size()).c_str());
  if (!mesh.ridges.empty())
    std::printf("  %-12s %12s\n", "ridges", with_commas(mesh.ridges.size()).c_str());
}

/// "  area         12: reference 1 (steel) 4, 2 (air) 8".
void print_sizes(const AnyMesh& mesh, std::size_t dimension, const Extents& extents) {
  constexpr std::array words = {"", "length", "area", "volume"};
  std::string text;
  std::size_t shown = 0;
  for (const auto& [reference, amount] : extents.amount_of.at(dimension))
    if (shown++ < shown_at_most)
      text += (shown == 1 ? "reference " : ", ") + std::to_string(reference) +
              name_after(mesh, dimension, reference) + format(": %.6g", amount.size);
  if (shown == 0) return;
  std::printf("  %-12s %12.6g  %s%s\n", words.at(dimension), extents.total(dimension).size,
              text.c_str(), shown > shown_at_most ? ", ..." : "");
}

void print_extents(const AnyMesh& mesh, const Extents& extents) {
  std::printf("  %-12s", "box");
  for (int k = 0; k < mesh.dimension; ++k)
    std::printf("%s %.6g to %.6g", k == 0 ? "" : ",", extents.box.low[k], extents.box.high[k]);
  std::printf("\n");
  for (std::size_t dimension = 1; dimension <= 3; ++dimension)
    print_sizes(mesh, dimension, extents);
  if (extents.largest_angle > 0)
    std::printf("  %-12s %.3g to %.4g degrees%s\n", "angles", extents.smallest_angle,
                extents.largest_angle, mesh.dimension == 3 ? ", dihedral" : "");
}

Json json_of(const Extents& extents, int dimension) {
  std::vector<Json> low, high;
  for (int k = 0; k < dimension; ++k) {
    low.emplace_back(extents.box.low[k]);
    high.emplace_back(extents.box.high[k]);
  }
  return json_object("low", json_list(low), "high", json_list(high), "length",
                     extents.total(1).size, "area", extents.total(2).size, "volume",
                     extents.total(3).size, "smallest_angle", extents.smallest_angle,
                     "largest_angle", extents.largest_angle);
}

/// The names of references, each with how many entities carry it, and their length, area or volume.
Json names_json(const AnyMesh& mesh, const Extents& extents) {
  std::vector<Json> names;
  for (const auto& [dimension, reference, name] : mesh.names) {
    const auto& amount_of = extents.amount_of.at(static_cast<std::size_t>(dimension));
    const auto found = amount_of.find(reference);
    const auto amount = found == amount_of.end() ? Extents::Amount{} : found->second;
    std::vector<Json> members{"name",      name,      "dimension", dimension,
                              "reference", reference, "count",     amount.count};
    if (dimension > 0) members.insert(members.end(), {"size", amount.size});
    names.push_back(json_object(members));
  }
  return json_list(names);
}

Json json_of(const AnyMesh& mesh, const Extents& extents, const Validity& validity,
             const Json& statistics) {
  return json_object("mesh", mesh.name, "dimension", mesh.dimension, "valid",
                     validity.reason.empty(), "vertices", mesh.vertex_count(), "edges",
                     mesh.edges.size(), "triangles", mesh.triangles.size(), "tetrahedra",
                     mesh.tetrahedra.size(), "extents", json_of(extents, mesh.dimension), "names",
                     names_json(mesh, extents), "statistics", statistics);
}

int work(const Executor& executor, const Arguments& arguments) {
  Warnings warnings;
  const AnyMesh mesh = read_mesh(input_of(arguments.operands()[0]), &warnings);
  std::optional<AnyField> metric;
  if (const auto path = arguments.text("-sol")) metric = read_metric(*path, mesh, warnings);
  const AnyField* const given = metric ? &*metric : nullptr;
  const auto json = arguments.text("--json");
  const bool shown = json != standard_output;
  const Extents extents = extents_of(mesh);
  if (shown) print_counts(mesh, extents);
  if (shown) print_extents(mesh, extents);
  const Validity validity = check(executor, mesh, given);
  warnings.insert(warnings.end(), validity.warnings.begin(), validity.warnings.end());
  if (shown)
    std::printf("  %s\n", validity.reason.empty() ? "valid: it can be adapted"
                                                  : ("not valid: " + validity.reason).c_str());
  Json statistics;
  if (element_count(mesh) > 0) {
    const auto measured = measure(executor, mesh, given);
    if (shown) std::printf("%s", to_text(measured).c_str());
    statistics = to_json(measured);
  }
  print_warnings(warnings);
  AtomicOutputs outputs;
  if (json) put_json(outputs, *json, json_of(mesh, extents, validity, statistics).text + "\n");
  outputs.commit();
  return validity.reason.empty() ? done : misused;
}

int run(const Arguments& arguments) {
  const fs::path input = only_mesh(arguments);
  if (const auto json = arguments.text("--json"); json && *json != standard_output) {
    expect_no_input(*json, {input, arguments.text("-sol").value_or("")});
    check_writable(*json);
  }
  return run_in_team({.threads = threads_of(arguments)},
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
