/// @file
/// Adapter: the driver. It owns the mesh while it is adapted and decides which kernel runs when.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/runtime/operator.hpp"
#include "mesh/mesh.hpp"
#include "operators/background.hpp"
#include "operators/edge_range.hpp"
#include "operators/edges.hpp"
#include "operators/smooth.hpp"
#include "operators/standing.hpp"
#include "operators/swap.hpp"

namespace ductile::meshadapt {

template <int Dim>
class Adapter {
 public:
  Adapter(const runtime::Executor& executor, const AdaptOptions& options, Mesh<Dim> mesh,
          Neighbours<Dim> neighbours, const std::vector<Metric<Dim>>& metric_of);

  /// Adapts the mesh. Either this or mend() may be called, once.
  void run();

  /// Changes only what it must of a mesh that came adapted.
  void mend();
  /// Adapts it as one that did not. The report's iterations are then those of this.
  void adapt_anew();

  /// What has become of a mesh that came more or less adapted: it is to be kept as it is now; or
  /// the one that came is better for it, and is to be mended, or left alone.
  enum class Outcome : std::uint8_t { good, better_mended, better_left };
  Outcome outcome() const { return outcome_; }

  const Mesh<Dim>& mesh() const { return mesh_; }
  /// Gives the mesh away, which is the end of this adapter's work.
  Mesh<Dim> take_mesh() {
    background_.release(executor_);
    survey_ = EdgeSurvey<Dim>();
    return std::move(mesh_);
  }
  AdaptReport& report() { return report_; }

 private:
  /// What the kernels that change lengths go for. The input is brought near the metric; then edges
  /// that are still too short are collapsed even if that makes some too long, for splits and swaps
  /// find a better way to fill the same place; in the end no edge leaves its range any more.
  enum class Aim : std::uint8_t { approach, rearrange, finish };

  // ---- Kernels: each returns how many changes it made ----
  std::size_t coarsen();
  std::size_t refine();
  struct Splits {
    std::size_t count;
    bool left_lists_stale;
    VertexId first_vertex;  // of those it made
  };
  Splits split_edges_above(double limit);
  std::size_t swap(int sweeps, double below);
  runtime::RoundsReport run_swaps(runtime::UnsetVector<Swappable> work);
  std::size_t smooth(int sweeps, double optimise_below, bool laplacian);
  void settle(std::uint32_t after);
  template <class Op>
  runtime::RoundsReport run_by_conflicts(Op& op, const runtime::UnsetVector<VertexId>& work) const;

  // ---- Steps, in the order of a run ----
  bool is_far() const;
  void come_near();
  bool has_too_many() const;
  void take_metrics();
  double share_to_change();
  void mend(double wanted);
  std::size_t iterate();
  void rearrange();
  void polish();
  void finish();

  Rules rules() const;
  EdgeRange range() const;
  SmoothOptions smoothing(double optimise_below, bool laplacian) const;
  std::size_t least_count() const;
  Standing standing() const;
  bool next_stage();
  std::size_t splits_to_come();
  double share(std::size_t changes) const;
  std::size_t elements_below(double mean_ratio) const;
  std::size_t elements_changed_after(std::uint32_t epoch) const;
  double long_edge() const;
  EdgeSurvey<Dim>& survey_for(double longer);
  std::uint32_t end_epoch(std::uint32_t& seen);
  void renumber_mesh(VertexId unlisted = none);
  std::size_t element_count() const;
  void tell(const char* step, std::size_t changes) const;
  void add(KernelReport& kernel, const runtime::RoundsReport& rounds);

  const runtime::Executor& executor_;
  const AdaptOptions& options_;
  Mesh<Dim> mesh_;
  Background<Dim> background_;
  EdgeSurvey<Dim> survey_;
  AdaptReport report_;
  Aim aim_ = Aim::approach;
  std::size_t stage_ = 0;      // of refinement
  bool came_adapted_ = false;  // or nearly
  Outcome outcome_ = Outcome::good;
  bool keeps_lengths_ = false;                        // see range()
  bool in_order_ = false;                             // renumbered since elements were made or gone
  mutable std::optional<std::size_t> element_count_;  // as far as it is known
  // The epoch up to which each kernel has seen all changes.
  std::uint32_t seen_by_coarsen_ = 0, seen_by_refine_ = 0, seen_by_swap_ = 0, seen_by_smooth_ = 0;
};

}  // namespace ductile::meshadapt
