/// @file
/// The report of `ductile adapt` about a run: a few lines for people, JSON for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "mesh/adjacency.hpp"

namespace ductile::cli {

struct MeshSummary {
  std::string name;
  int dimension = 0;
  std::size_t vertices = 0, edges = 0, triangles = 0, tetrahedra = 0;
  std::optional<meshadapt::MeshStatistics> statistics;
};

/// An option with a number: "hmin", 0.1.
struct ValueInForce {
  std::string option;
  double value = 0;
};

struct MetricInForce {
  std::string source;  ///< "part.sol (found beside the mesh)"
  std::vector<ValueInForce> values;
};

struct AdaptSummary {
  MeshSummary before, after;
  MetricInForce in_force;
  meshadapt::AdaptReport report;
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
AdaptSummary summarise(const meshadapt::AdjacentMesh& before, const meshadapt::AnyField& metric,
                       const meshadapt::AdaptedMesh& adapted, const meshadapt::AdjacentMesh& after,
                       const SummaryOptions& options);

std::string to_text(const AdaptSummary& summary, bool with_histograms);
/// `cut` is the object about a level set, or null.
std::string to_json(const AdaptSummary& summary, const std::string& cut = "null");

}  // namespace ductile::cli
