/// @file
/// Adapter: adapts a mesh to one metric. It owns the mesh meanwhile and follows the schedule.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "adapt/schedule.hpp"
#include "adapt/workpiece.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "mesh/mesh.hpp"
#include "operators/standing.hpp"

namespace ductile::meshadapt {

/// How much of the schedule is for a mesh: all phases; what it needs, for one that may have come
/// adapted; only the finish, for what is left to do in one that did; nothing.
enum class Effort : std::uint8_t { everything, as_needed, mending, nothing };

template <int Dim, int Space = Dim>
class Adapter {
 public:
  /// Refers to the options and the report, which may be that of earlier runs.
  Adapter(const runtime::Executor& executor, const AdaptOptions& options, Start<Dim, Space> start,
          AdaptReport& report);

  /// Adapts the mesh, once. If it came adapted and was better than it is now, returns the effort
  /// that should be tried on the mesh that came instead. The report's iterations are those of this.
  std::optional<Effort> run(Effort effort);

  const Mesh<Dim, Space>& mesh() const { return work_.mesh(); }
  /// Gives the mesh away, which is the end of this adapter's work.
  Mesh<Dim, Space> take_mesh() { return work_.take_mesh(); }

 private:
  AdaptReport& report() { return work_.report(); }

  // ---- The schedule ----
  std::optional<Effort> adapt_as_needed();
  void adapt_anew();
  void approach(const Phase& phase);
  void follow(const Phase& phase);
  std::size_t pass(const Phase& phase);

  // ---- A mesh that came adapted ----
  double share_to_change();
  bool mend(double wanted);
  Standing standing() const;
  std::size_t least_count() const;

  // ---- A metric that is far from the mesh ----
  bool is_far() const;
  void come_near(const Phase& phase);
  bool has_too_many() const;

  std::size_t splits_to_come();
  std::size_t count_elements(auto&& counts) const;
  std::size_t elements_below(double mean_ratio) const;
  std::size_t elements_changed_after(std::uint32_t epoch) const;

  const runtime::Executor& executor_;
  const AdaptOptions& options_;
  Workpiece<Dim, Space> work_;
  bool came_adapted_ = false;  // or nearly
};

}  // namespace ductile::meshadapt
