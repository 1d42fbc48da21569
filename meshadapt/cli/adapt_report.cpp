#include "adapt_report.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/runtime/process.hpp"
#include "mesh/array_lengths.hpp"
#include "metric/measure.hpp"

namespace ductile::cli {

namespace {

std::string counts(const AnyMesh& mesh) {
  std::string text = mesh.name + ": " + counted(mesh.vertex_count(), "vertex", "vertices") + ", " +
                     counted(mesh.triangles.size(), "triangle", "triangles");
  if (element_dimension(mesh) == 3)
    text += ", " + counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra");
  return text + "\n";
}

/// About how many elements the metric asks for; 0 if it was not measured.
std::size_t elements_wanted(const MeasuredMesh& measured) {
  if (!measured.statistics || !measured.statistics->in_metric) return 0;
  const double each = complexity_of_elements(element_dimension(measured.mesh), 1);
  return static_cast<std::size_t>(
      std::lround(std::min(measured.statistics->complexity / each, 1e18)));
}

/// "metric: part.sol (found beside the mesh); -hmax 0.1, -hgrad 1.3".
std::string in_words(const MetricInForce& in_force) {
  const std::string options = listed(
      in_force.values, [](const auto& one) { return format("-%s %g", one.first, one.second); });
  return printable("metric: " + in_force.source + (options.empty() ? "" : "; ") + options) + "\n";
}

std::string demand_in_words(const MeasuredMesh& measured) {
  const std::size_t wanted = elements_wanted(measured);
  if (wanted == 0) return {};
  return "  the metric asks for about " + with_commas(wanted) + " elements, the mesh has " +
         with_commas(element_count(measured.mesh)) + "\n";
}

Json to_json(const MetricInForce& in_force) {
  std::vector<Json> options;
  for (const auto& [option, value] : in_force.values)
    options.insert(options.end(), {option, value});
  return json_object("source", in_force.source, "options", json_object(options));
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
      "  boundary: " + (summary.after.mesh.dimension == 2
                            ? counted(summary.ridges, "corner", "corners")
                            : counted(summary.ridges, "edge of ridges", "edges of ridges"));
  if (summary.distance) text += format(", within %.3g of where it was", *summary.distance);
  return text + "\n";
}

std::string figures(const MeasuredMesh& measured, bool with_histograms) {
  if (!measured.statistics) return {};
  const MeshStatistics& s = *measured.statistics;
  if (with_histograms) return to_text(s);
  return format(
      "  %.2f %% of %s edges in [0.71, 1.41], shortest %.3g, longest %.3g\n"
      "  quality: mean %.3f, 1 %% below %.3f, worst %.3g\n",
      100 * s.share_in_range(), with_commas(s.edge_length.count).c_str(), s.edge_length.min,
      s.edge_length.max, s.quality.mean, s.quality.low, s.quality.min);
}

Json to_json(const KernelReport& kernel) {
  return json_object("seconds", kernel.seconds, "considered", kernel.considered, "applied",
                     kernel.applied, "rounds", kernel.rounds);
}

/// Advice for a mesh that is far from its metric: edges are long because it is too far from the
/// input, or short because of fixed vertices, the tolerance of curved boundaries (which shows in a
/// larger share of short edges on them), or corners that too small an angle of ridges makes.
std::vector<std::string> advice(const MeshStatistics& statistics, const AdaptedMesh& after,
                                const SummaryOptions& options) {
  constexpr double many_long = 0.25, many_short = 0.1, in_part = 0.25;
  constexpr std::size_t more_than_few = 32;
  const AdaptReport& report = after.report;
  const auto share_of = [&](std::size_t count) {
    return static_cast<double>(count) /
           static_cast<double>(std::max<std::size_t>(1, statistics.edge_length.count));
  };
  std::vector<std::string> all;
  const auto say = [&](bool applies, double share, const std::string& text) {
    if (applies)
      all.push_back(std::to_string(std::lround(100 * share)) + " % of the edges are " + text);
  };
  const double longer = share_of(statistics.edges_long), shorter = share_of(statistics.edges_short);
  say(longer >= many_long, longer,
      "longer than asked for: the metric is too far from the mesh; adapt the result again, or first"
      " to a metric whose sizes differ less between directions (ductile metric bound "
      "--anisotropy)");
  if (shorter < many_short) return all;
  say(options.keeps_surface && report.fixed_vertices >= more_than_few, shorter,
      "shorter than asked for; if they are on curved boundaries, -hausd X lets these be up to X "
      "from"
      " where they are");
  if (options.hausdorff_tolerance == 0) return all;
  const auto here = static_cast<double>(report.curved_edges_short);
  say(report.curved_edges_short >= more_than_few &&
          here >= in_part * static_cast<double>(statistics.edges_short) &&
          here >= shorter * static_cast<double>(report.curved_edges),
      shorter,
      format("shorter than asked for: curved boundaries have to stay within %g (-hausd) of where"
             " they were; a larger one would help, and -hgrad X lets sizes grow gently from there",
             options.hausdorff_tolerance));
  say(report.fixed_vertices * 4 >= after.mesh.vertex_count(), shorter,
      "shorter than asked for: " + std::to_string(report.fixed_vertices) +
          " vertices are corners of the boundary or required, and stay; with a larger angle -ar"
          " fewer of a curved one are");
  return all;
}

}  // namespace

Json to_json(const MeasuredMesh& measured) {
  const AnyMesh& mesh = measured.mesh;
  return json_object("file", mesh.name, "dimension", mesh.dimension, "vertices",
                     mesh.vertex_count(), "edges", mesh.edges.size(), "triangles",
                     mesh.triangles.size(), "tetrahedra", mesh.tetrahedra.size(), "statistics",
                     measured.statistics ? to_json(*measured.statistics) : Json());
}

AdaptSummary summarise(const AdjacentMesh& before, const AnyField& metric,
                       const AdaptedMesh& adapted, const AdjacentMesh& after,
                       const SummaryOptions& options) {
  AdaptSummary summary{.before = {before.mesh()},
                       .after = {after.mesh()},
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
  std::string text = counts(summary.before.mesh) + figures(summary.before, with_histograms);
  if (!summary.in_force.source.empty()) text += in_words(summary.in_force);
  text += format("adapted in %.2f s on ", report.total_seconds) +
          counted(static_cast<std::size_t>(summary.threads), "thread", "threads") + ", " +
          counted(static_cast<std::size_t>(report.iterations), "iteration", "iterations") +
          (report.converged ? "" : " (the most allowed; more may help: --iterations)") +
          ", peak memory " + with_commas(summary.peak_memory >> 20U) + " MB\n ";
  for (const auto& [name, kernel] : kernels)
    text += " " + std::string(name) + format(" %.2f s,", (report.*kernel).seconds);
  text +=
      format(" set-up %.2f s, renumbering %.2f s\n", report.setup_seconds, report.renumber_seconds);
  return text + counts(summary.after.mesh) + demand_in_words(summary.after) +
         figures(summary.after, with_histograms) + boundary_in_words(summary) + held_edges(report);
}

Json to_json(const AdaptSummary& summary, const Json& cut) {
  const AdaptReport& report = summary.report;
  std::vector<Json> kernel_list;
  for (const auto& [name, kernel] : kernels)
    kernel_list.insert(kernel_list.end(), {name, to_json(report.*kernel)});
  return json_lines(
      {json_object("before", to_json(summary.before)), json_object("after", to_json(summary.after)),
       json_object("cut", cut),
       json_object("metric", to_json(summary.in_force), "elements_wanted",
                   elements_wanted(summary.after), "elements", element_count(summary.after.mesh),
                   "ridges", summary.ridges, "distance", summary.distance),
       json_object("threads", summary.threads, "deterministic", summary.deterministic,
                   "instructions", report.instructions, "iterations", report.iterations,
                   "converged", report.converged, "held_long_edges", report.held_long_edges,
                   "held_short_edges", report.held_short_edges),
       json_object("kernels", json_object(kernel_list)),
       json_object("seconds",
                   json_object("total", report.total_seconds, "setup", report.setup_seconds,
                               "renumber", report.renumber_seconds)),
       json_object("peak_memory_bytes", summary.peak_memory),
       json_object("warnings", json_list({report.warnings.begin(), report.warnings.end()}))});
}

}  // namespace ductile::cli
