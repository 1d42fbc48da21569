#include "adapt_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/runtime/process.hpp"
#include "files.hpp"
#include "metric/measure.hpp"
#include "report.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AdaptReport;
using meshadapt::AnyMesh;
using meshadapt::KernelReport;

MeshSummary summarise_mesh(const AnyMesh& mesh) {
  return {mesh.name,         mesh.dimension,        mesh.vertex_count(),
          mesh.edges.size(), mesh.triangles.size(), mesh.tetrahedra.size(),
          std::nullopt};
}

/// False of a surface, and in the plane.
bool has_tetrahedra(const MeshSummary& mesh) {
  return mesh.dimension == 3 && (mesh.tetrahedra > 0 || mesh.triangles == 0);
}

std::string counts(const MeshSummary& mesh) {
  std::string text = mesh.name + ": " + counted(mesh.vertices, "vertex", "vertices") + ", " +
                     counted(mesh.triangles, "triangle", "triangles");
  if (has_tetrahedra(mesh)) text += ", " + counted(mesh.tetrahedra, "tetrahedron", "tetrahedra");
  return text + "\n";
}

std::size_t element_count(const MeshSummary& mesh) {
  return has_tetrahedra(mesh) ? mesh.tetrahedra : mesh.triangles;
}

/// About how many elements the metric asks for; 0 if it was not measured.
std::size_t elements_wanted(const MeshSummary& mesh) {
  if (!mesh.statistics || !mesh.statistics->in_metric) return 0;
  const double each = meshadapt::complexity_of_elements(has_tetrahedra(mesh) ? 3 : 2, 1);
  return static_cast<std::size_t>(std::lround(std::min(mesh.statistics->complexity / each, 1e18)));
}

/// "metric: part.sol (found beside the mesh); -hmax 0.1, -hgrad 1.3".
std::string in_words(const MetricInForce& in_force) {
  std::string text = "metric: " + in_force.source;
  for (const auto& [option, value] : in_force.values) {
    std::array<char, 64> words;
    std::snprintf(words.data(), words.size(), " -%s %g", option.c_str(), value);
    text += (&option == &in_force.values[0].option ? ";" : ",") + std::string(words.data());
  }
  return meshadapt::printable(text) + "\n";
}

std::string demand_in_words(const MeshSummary& mesh) {
  const std::size_t wanted = elements_wanted(mesh);
  if (wanted == 0) return {};
  return "  the metric asks for about " + with_commas(wanted) + " elements, the mesh has " +
         with_commas(element_count(mesh)) + "\n";
}

std::string json_of(const MetricInForce& in_force) {
  std::string options;
  for (const auto& [option, value] : in_force.values)
    options += (options.empty() ? "" : ", ") + json_string(option) + ": " + json_number(value);
  return "{\"source\": " + json_string(in_force.source) + ", \"options\": {" + options + "}}";
}

std::string seconds(double s) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2f s", s);
  return text.data();
}

/// The two lines of figures that sum up a mesh.
std::string short_figures(const meshadapt::MeshStatistics& s) {
  std::array<char, 256> text;
  std::snprintf(text.data(), text.size(),
                "  %.2f %% of %s edges in [0.71, 1.41], shortest %.3g, longest %.3g\n"
                "  quality: mean %.3f, 1 %% below %.3f, worst %.3g\n",
                100 * s.share_in_range(), with_commas(s.edge_length.count).c_str(),
                s.edge_length.min, s.edge_length.max, s.quality.mean, s.quality.low, s.quality.min);
  return text.data();
}

/// A line about edges that required entities keep too long or too short; empty without such edges.
std::string held_edges(const AdaptReport& report) {
  if (report.held_long_edges + report.held_short_edges == 0) return {};
  return "  required entities hold " + with_commas(report.held_long_edges) + " edges longer and " +
         with_commas(report.held_short_edges) + " shorter than asked for\n";
}

/// "  boundary: 312 edges of ridges, within 0.043 of where it was (-hausd 0.05)".
std::string boundary_in_words(const AdaptSummary& summary) {
  std::string text =
      "  boundary: " + (summary.after.dimension == 2
                            ? counted(summary.ridges, "corner", "corners")
                            : counted(summary.ridges, "edge of ridges", "edges of ridges"));
  if (summary.distance) {
    std::array<char, 64> words;
    std::snprintf(words.data(), words.size(), ", within %.3g of where it was", *summary.distance);
    text += words.data();
  }
  return text + "\n";
}

std::string figures(const MeshSummary& mesh, bool with_histograms) {
  if (!mesh.statistics) return {};
  return with_histograms ? to_text(*mesh.statistics) : short_figures(*mesh.statistics);
}

std::string json_of(const MeshSummary& mesh) {
  return "{\"file\": " + json_string(mesh.name) +
         ", \"dimension\": " + std::to_string(mesh.dimension) +
         ", \"vertices\": " + std::to_string(mesh.vertices) +
         ", \"edges\": " + std::to_string(mesh.edges) +
         ", \"triangles\": " + std::to_string(mesh.triangles) +
         ", \"tetrahedra\": " + std::to_string(mesh.tetrahedra) +
         ", \"statistics\": " + (mesh.statistics ? to_json(*mesh.statistics) : "null") + "}";
}

std::string json_of(const KernelReport& kernel) {
  return "{\"seconds\": " + json_number(kernel.seconds) +
         ", \"considered\": " + std::to_string(kernel.considered) +
         ", \"applied\": " + std::to_string(kernel.applied) +
         ", \"rounds\": " + std::to_string(kernel.rounds) + "}";
}

double share_of_edges(const meshadapt::MeshStatistics& statistics, std::size_t count) {
  return static_cast<double>(count) /
         static_cast<double>(std::max<std::size_t>(1, statistics.edge_length.count));
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

constexpr double many_short = 0.1;

/// Advice for a mesh that is far from its metric; otherwise empty.
std::string advice_on_lengths(const meshadapt::MeshStatistics& statistics) {
  constexpr double many = 0.25;
  const double share = share_of_edges(statistics, statistics.edges_long);
  if (share < many) return {};
  return percent(share) +
         " of the edges are longer than asked for: the metric is too far from the mesh; adapt the"
         " result again, or first to a metric whose sizes differ less between directions"
         " (ductile metric bound --anisotropy)";
}

/// Advice for a mesh that fixed vertices keep finer than its metric; otherwise empty.
std::string advice_on_surface(const meshadapt::MeshStatistics& statistics,
                              const AdaptReport& report) {
  constexpr std::size_t more_than_corners = 32;
  const double share = share_of_edges(statistics, statistics.edges_short);
  if (share < many_short || report.fixed_vertices < more_than_corners) return {};
  return percent(share) +
         " of the edges are shorter than asked for; if they are on curved boundaries, -hausd X"
         " lets these be up to X from where they are";
}

/// Advice for a mesh that the tolerance of curved boundaries keeps finer than its metric, which
/// shows in a larger share of short edges on them; otherwise empty.
std::string advice_on_tolerance(const meshadapt::MeshStatistics& statistics,
                                const AdaptReport& report, double tolerance) {
  constexpr std::size_t more_than_few = 32;
  constexpr double in_part = 0.25;
  const double share = share_of_edges(statistics, statistics.edges_short);
  const auto here = static_cast<double>(report.curved_edges_short);
  if (share < many_short || report.curved_edges_short < more_than_few ||
      here < in_part * static_cast<double>(statistics.edges_short) ||
      here < share * static_cast<double>(report.curved_edges))
    return {};
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%g", tolerance);
  return percent(share) +
         " of the edges are shorter than asked for: curved boundaries have to stay within " +
         text.data() +
         " (-hausd) of where they were; a larger one would help, and -hgrad X lets"
         " sizes grow gently from there";
}

/// Advice for a mesh with many corners, which too small an angle of ridges makes; otherwise empty.
std::string advice_on_ridges(const meshadapt::MeshStatistics& statistics, const AdaptReport& report,
                             std::size_t vertices) {
  constexpr std::size_t in_part = 4;
  const double share = share_of_edges(statistics, statistics.edges_short);
  if (share < many_short || report.fixed_vertices * in_part < vertices) return {};
  return percent(share) +
         " of the edges are shorter than asked for: " + std::to_string(report.fixed_vertices) +
         " vertices are corners of the boundary or required, and stay; with a larger angle -ar"
         " fewer of a curved one are";
}

/// All advice about lengths.
std::vector<std::string> advice(const meshadapt::MeshStatistics& statistics,
                                const meshadapt::AdaptedMesh& after,
                                const SummaryOptions& options) {
  const AdaptReport& report = after.report;
  std::vector<std::string> all{advice_on_lengths(statistics)};
  if (options.keeps_surface) all.push_back(advice_on_surface(statistics, report));
  if (options.hausdorff_tolerance > 0) {
    all.push_back(advice_on_tolerance(statistics, report, options.hausdorff_tolerance));
    all.push_back(advice_on_ridges(statistics, report, after.mesh.vertex_count()));
  }
  std::erase(all, "");
  return all;
}

}  // namespace

AdaptSummary summarise(const meshadapt::AdjacentMesh& before, const meshadapt::AnyField& metric,
                       const meshadapt::AdaptedMesh& adapted, const meshadapt::AdjacentMesh& after,
                       const SummaryOptions& options) {
  AdaptSummary summary{.before = summarise_mesh(before.mesh()),
                       .after = summarise_mesh(after.mesh()),
                       .in_force = options.in_force,
                       .report = adapted.report,
                       .threads = after.executor().threads(),
                       .deterministic = after.executor().deterministic()};
  summary.peak_memory = runtime::peak_memory();
  if (options.before) summary.before.statistics = measure(before, &metric);
  if (options.after) summary.after.statistics = measure(after, &adapted.metric);
  if (options.expects_lengths && summary.after.statistics)
    for (std::string& said : advice(*summary.after.statistics, adapted, options))
      summary.report.warnings.push_back(std::move(said));
  return summary;
}

std::string to_text(const AdaptSummary& summary, bool with_histograms) {
  const AdaptReport& report = summary.report;
  std::string text = counts(summary.before) + figures(summary.before, with_histograms);
  if (!summary.in_force.source.empty()) text += in_words(summary.in_force);
  text += "adapted in " + seconds(report.total_seconds) + " on " +
          counted(static_cast<std::size_t>(summary.threads), "thread", "threads") + ", " +
          counted(static_cast<std::size_t>(report.iterations), "iteration", "iterations") +
          (report.converged ? "" : " (the most allowed; more may help: --iterations)") +
          ", peak memory " + with_commas(summary.peak_memory >> 20U) + " MB\n ";
  for (const auto& [name, kernel] : meshadapt::kernels)
    text += " " + std::string(name) + " " + seconds((report.*kernel).seconds) + ",";
  text += " set-up " + seconds(report.setup_seconds) + ", renumbering " +
          seconds(report.renumber_seconds) + "\n";
  return text + counts(summary.after) + demand_in_words(summary.after) +
         figures(summary.after, with_histograms) + boundary_in_words(summary) + held_edges(report);
}

std::string to_json(const AdaptSummary& summary, const std::string& cut) {
  const AdaptReport& report = summary.report;
  std::string kernel_list, warnings;
  for (const auto& [name, kernel] : meshadapt::kernels)
    kernel_list +=
        (kernel_list.empty() ? "" : ", ") + json_string(name) + ": " + json_of(report.*kernel);
  for (const std::string& warning : report.warnings)
    warnings += (warnings.empty() ? "" : ", ") + json_string(warning);
  return "{\"before\": " + json_of(summary.before) + ",\n \"after\": " + json_of(summary.after) +
         ",\n \"cut\": " + cut + ",\n \"metric\": " + json_of(summary.in_force) +
         ", \"elements_wanted\": " + std::to_string(elements_wanted(summary.after)) +
         ", \"elements\": " + std::to_string(element_count(summary.after)) +
         ", \"ridges\": " + std::to_string(summary.ridges) +
         ", \"distance\": " + (summary.distance ? json_number(*summary.distance) : "null") +
         ",\n \"threads\": " + std::to_string(summary.threads) +
         ", \"deterministic\": " + (summary.deterministic ? "true" : "false") +
         ", \"instructions\": " + json_string(std::string(report.instructions)) +
         ", \"iterations\": " + std::to_string(report.iterations) +
         ", \"converged\": " + (report.converged ? "true" : "false") +
         ", \"held_long_edges\": " + std::to_string(report.held_long_edges) +
         ", \"held_short_edges\": " + std::to_string(report.held_short_edges) +
         ",\n \"kernels\": {" + kernel_list +
         "},\n \"seconds\": {\"total\": " + json_number(report.total_seconds) +
         ", \"setup\": " + json_number(report.setup_seconds) +
         ", \"renumber\": " + json_number(report.renumber_seconds) +
         "},\n \"peak_memory_bytes\": " + std::to_string(summary.peak_memory) +
         ",\n \"warnings\": [" + warnings + "]}\n";
}

}  // namespace ductile::cli
