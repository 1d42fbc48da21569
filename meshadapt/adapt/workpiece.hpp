/// @file
/// Workpiece: a mesh while it is adapted, and what its kernels share: the metric that it came with,
/// the aim of the current phase, what each kernel has seen, and the report.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adapt/schedule.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/operator.hpp"
#include "mesh/mesh.hpp"
#include "operators/background.hpp"
#include "operators/edge_range.hpp"
#include "operators/edge_survey.hpp"
#include "operators/smooth.hpp"

namespace ductile::meshadapt {

/// The mesh, its adjacency and the metrics that an adaptation starts from.
template <int Dim, int Space = Dim>
struct Start {
  Mesh<Dim, Space> mesh;
  Neighbours<Dim> neighbours;
  std::vector<Metric<Space>> metric_of;  ///< [vertex]
};

/// Thread safety: one caller; what takes time runs on the executor.
template <int Dim, int Space = Dim>
class Workpiece {
 public:
  /// Puts the mesh in order. Refers to the options and the report.
  Workpiece(const runtime::Executor& executor, const AdaptOptions& options, Start<Dim, Space> start,
            AdaptReport& report);

  const runtime::Executor& executor() const { return executor_; }
  const AdaptOptions& options() const { return options_; }
  Mesh<Dim, Space>& mesh() { return mesh_; }
  const Mesh<Dim, Space>& mesh() const { return mesh_; }
  Background<Dim, Space>& background() { return background_; }
  const Background<Dim, Space>& background() const { return background_; }
  AdaptReport& report() { return report_; }
  Mesh<Dim, Space> take_mesh();

  // ---- The schedule ----
  /// Begins a phase. In a mesh that came adapted, steps that look everywhere only look at what
  /// changes from now on.
  void begin(const Phase& phase, bool came_adapted);
  /// Sets what kernels go for, and whether moves and swaps may lead edges out of the rules' range.
  void go_for(Aim aim, bool keeps_lengths);
  /// Splits shorter edges from now on; false if all that are too long are split already.
  bool next_stage();
  void go_to_last_stage() { stage_ = last_stage; }

  // ---- What kernels follow ----
  Rules rules() const;
  EdgeRange range() const;
  SmoothOptions smoothing(const Step& step) const;
  double long_edge() const;
  EdgeSurvey<Dim, Space>& survey_for(double longer);
  void forget_survey() { survey_.forget(); }

  // ---- What kernels have seen, and what they did ----
  std::uint32_t end_epoch(Kernel kernel);
  void look_at_all(Kernel kernel) { seen_by_[index_of(kernel)] = 0; }
  void look_everywhere(Kernel kernel) { seen_by_[index_of(kernel)] = everywhere_after_; }
  KernelReport& report_of(Kernel kernel) { return report_.*kernels[index_of(kernel)].report; }
  void add(Kernel kernel, const runtime::RoundsReport& rounds);
  void tell(Kernel kernel, std::size_t changes) const;

  // ---- Counts ----
  std::size_t element_count() const;
  double share(std::size_t changes) const;

  bool is_in_order() const { return in_order_; }
  /// Also makes lists of elements of vertices from `unlisted` on, which have none yet.
  void renumber_mesh(VertexId unlisted = none);
  /// Gives all vertices the metrics that the background has now.
  void take_metrics();

 private:
  static constexpr std::size_t last_stage = std::size(Tuning<Dim>::stages) - 1;

  const runtime::Executor& executor_;
  const AdaptOptions& options_;
  Mesh<Dim, Space> mesh_;
  Background<Dim, Space> background_;
  EdgeSurvey<Dim, Space> survey_;
  AdaptReport& report_;

  Aim aim_ = Aim::approach;
  bool keeps_lengths_ = false;
  std::size_t stage_ = 0;                                // of refinement
  std::array<std::uint32_t, kernels.size()> seen_by_{};  // [kernel], all up to this epoch
  std::uint32_t everywhere_after_ = 0;                   // an epoch, see begin()
  bool in_order_ = false;                                // since elements were made or gone
  mutable std::optional<std::size_t> element_count_;     // as far as it is known
};

}  // namespace ductile::meshadapt
