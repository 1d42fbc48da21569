/// @file
/// Adapter: the driver. It owns the mesh while it is adapted and follows the schedule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adapt/schedule.hpp"
#include "adapt/workpiece.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "mesh/mesh.hpp"
#include "operators/standing.hpp"

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

  const Mesh<Dim>& mesh() const { return work_.mesh(); }
  /// Gives the mesh away, which is the end of this adapter's work.
  Mesh<Dim> take_mesh() { return work_.take_mesh(); }
  AdaptReport& report() { return work_.report(); }

 private:
  // ---- The schedule ----
  std::size_t pass(const Phase& phase);
  void run(const Phase& phase);
  void approach(const Phase& phase);

  // ---- A mesh that came adapted ----
  double share_to_change();
  void mend(double wanted);
  Standing standing() const;
  std::size_t least_count() const;

  // ---- A metric that is far from the mesh ----
  bool is_far() const;
  void come_near(const Phase& phase);
  bool has_too_many() const;

  std::size_t splits_to_come();
  std::size_t elements_below(double mean_ratio) const;
  std::size_t elements_changed_after(std::uint32_t epoch) const;

  const runtime::Executor& executor_;
  const AdaptOptions& options_;
  Workpiece<Dim> work_;
  bool came_adapted_ = false;  // or nearly
  Outcome outcome_ = Outcome::good;
};

}  // namespace ductile::meshadapt
