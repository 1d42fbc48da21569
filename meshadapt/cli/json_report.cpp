#include "json_report.hpp"

#include <array>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "files.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyMesh;
using Json = nlohmann::ordered_json;

Json json_of(const meshadapt::Distribution& d) {
  return {{"count", d.count},
          {"min", d.min},
          {"p01", d.low},
          {"median", d.median},
          {"mean", d.mean},
          {"max", d.max},
          {"histogram_from", d.histogram_from},
          {"histogram_to", d.histogram_to},
          {"histogram", d.histogram},
          {"below", d.below},
          {"above", d.above}};
}

Json json_of(const std::optional<meshadapt::MeshStatistics>& s) {
  if (!s) return nullptr;
  Json json{{"in_metric", s->in_metric},
            {"edge_length", json_of(s->edge_length)},
            {"quality", json_of(s->quality)}};
  if (s->in_metric)
    json.update({{"edges_short", s->edges_short},
                 {"edges_in_range", s->edges_in_range},
                 {"edges_long", s->edges_long},
                 {"share_in_range", s->share_in_range()},
                 {"complexity", s->complexity}});
  return json;
}

Json json_of(const MeshSummary& mesh) {
  return {{"file", as_utf8(mesh.name)},
          {"dimension", mesh.dimension},
          {"vertices", mesh.vertices},
          {"edges", mesh.edges},
          {"triangles", mesh.triangles},
          {"tetrahedra", mesh.tetrahedra},
          {"statistics", json_of(mesh.statistics)}};
}

Json json_of(const meshadapt::KernelReport& kernel) {
  return {{"seconds", kernel.seconds},
          {"considered", kernel.considered},
          {"applied", kernel.applied},
          {"rounds", kernel.rounds}};
}

/// The names of references, each with how many entities carry it.
Json names_of(const AnyMesh& mesh) {
  const std::array references{&mesh.vertex_reference, &mesh.edges.reference,
                              &mesh.triangles.reference, &mesh.tetrahedra.reference};
  std::map<std::pair<int, std::int32_t>, std::size_t> count_of;  // [dimension, reference]
  for (int dimension = 0; dimension <= 3 && !mesh.names.empty(); ++dimension)
    for (const std::int32_t reference : *references[static_cast<std::size_t>(dimension)])
      ++count_of[{dimension, reference}];
  Json names = Json::array();
  for (const auto& [dimension, reference, name] : mesh.names)
    names.push_back({{"name", as_utf8(name)},
                     {"dimension", dimension},
                     {"reference", reference},
                     {"count", count_of[{dimension, reference}]}});
  return names;
}

/// On one line, with a blank after each comma and colon, which people read more easily.
std::string written(const Json& json) {
  std::string text;
  bool in_string = false, escaped = false;
  for (const char c : json.dump()) {
    text += c;
    if (c == '"' && !escaped) in_string = !in_string;
    escaped = in_string && c == '\\' && !escaped;
    if (!in_string && (c == ',' || c == ':')) text += ' ';
  }
  return text + "\n";
}

}  // namespace

std::string to_json(const AdaptSummary& summary) {
  const meshadapt::AdaptReport& report = summary.report;
  Json warnings = Json::array(), kernels;
  for (const auto& [name, kernel] : meshadapt::kernels) kernels[name] = json_of(report.*kernel);
  for (const std::string& warning : report.warnings) warnings.push_back(as_utf8(warning));
  return written({{"before", json_of(summary.before)},
                  {"after", json_of(summary.after)},
                  {"threads", summary.threads},
                  {"deterministic", summary.deterministic},
                  {"instructions", report.instructions},
                  {"iterations", report.iterations},
                  {"converged", report.converged},
                  {"held_long_edges", report.held_long_edges},
                  {"held_short_edges", report.held_short_edges},
                  {"kernels", kernels},
                  {"seconds",
                   {{"total", report.total_seconds},
                    {"setup", report.setup_seconds},
                    {"renumber", report.renumber_seconds}}},
                  {"peak_memory_bytes", summary.peak_memory},
                  {"warnings", warnings}});
}

std::string to_json(const AnyMesh& mesh, bool valid,
                    const std::optional<meshadapt::MeshStatistics>& statistics) {
  return written({{"mesh", as_utf8(mesh.name)},
                  {"dimension", mesh.dimension},
                  {"valid", valid},
                  {"vertices", mesh.vertex_count()},
                  {"edges", mesh.edges.size()},
                  {"triangles", mesh.triangles.size()},
                  {"tetrahedra", mesh.tetrahedra.size()},
                  {"names", names_of(mesh)},
                  {"statistics", json_of(statistics)}});
}

}  // namespace ductile::cli
