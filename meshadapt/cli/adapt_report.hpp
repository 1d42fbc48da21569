/// @file
/// The report of `ductile adapt` about a run: a few lines for people, JSON for programs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "mesh/adjacency.hpp"
#include "report.hpp"

namespace ductile::cli {

struct MeasuredMesh {
  const AnyMesh& mesh;
  std::optional<MeshStatistics> statistics{};
};
Json to_json(const MeasuredMesh& measured);

/// The metric that a mesh is adapted to.
struct MetricInForce {
  std::string source;                                  ///< "part.sol (found beside the mesh)"
  std::vector<std::pair<const char*, double>> values;  ///< options about sizes: "hmin", 0.1
};

/// The meshes before and after must outlive it.
struct AdaptSummary {
  MeasuredMesh before, after;
  MetricInForce in_force;
  AdaptReport report;
  int threads = 0;
  bool deterministic = true;
  std::size_t peak_memory = 0;
  std::size_t ridges = 0;  ///< edges, in 2D vertices, where the adapted boundary turns
  std::optional<double>
      distance{};  ///< of curved boundaries from where they were; none: not measured
};

struct SummaryOptions {
  bool before = true, after = true;  ///< which meshes to measure
  bool expects_lengths = true;       ///< a warning is added if too many edges are too long
  bool keeps_surface = false;        ///< ... or too short, which curved boundaries may be why
  double hausdorff_tolerance = 0;    ///< ... or are, because they stay within this; 0: they stay
  MetricInForce in_force = {};
};

/// `after` is the mesh of `adapted`.
AdaptSummary summarise(const AdjacentMesh& before, const AnyField& metric,
                       const AdaptedMesh& adapted, const AdjacentMesh& after,
                       const SummaryOptions& options);

std::string to_text(const AdaptSummary& summary, bool with_histograms);
/// `cut` is the object about a level set, or null.
Json to_json(const AdaptSummary& summary, const Json& cut);

}  // namespace ductile::cli
