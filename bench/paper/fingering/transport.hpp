/// @file
/// Transport of the saturation by a given flow, with diffusion: explicit, conservative and within
/// bounds. Each step is first taken with upwind fluxes, which keep bounds but smear; the difference
/// to central fluxes, which are of second order, is then added as far as no new extremum arises
/// (flux-corrected transport: Zalesak, J. Comput. Phys. 31, 1979). Two such steps make one of Heun.
#pragma once

#include <vector>

#include "ductile/runtime/executor.hpp"
#include "fingering/dual_mesh.hpp"
#include "fingering/pressure.hpp"

namespace ductile::paper {

/// Injected and produced amounts of the fluid with saturation 1 so far, as areas.
struct Ledger {
  double injected = 0, produced = 0;
};

class Transport {
 public:
  /// Keeps references to executor and mesh, but not to the flow.
  Transport(const runtime::Executor& executor, const DualMesh& dual, const Fluids& fluids,
            const Flow& flow);

  /// Advances by `interval` in as many equal steps as bounds require; returns their number. Thread
  /// safety: one caller; runs on the executor.
  int advance(std::vector<double>& saturation_of, Ledger& ledger, double interval);

 private:
  double largest_step() const;
  void take_step(std::vector<double>& saturation_of, Ledger& ledger, double step);
  double low_order(VertexId vertex, const std::vector<double>& old_of, double step) const;
  void find_limits(VertexId vertex, const std::vector<double>& old_of, double step);
  double corrected(VertexId vertex, const std::vector<double>& old_of, double step) const;

  /// The correction to the upwind flux along an edge, before limiting.
  double correction(EdgeId edge, const std::vector<double>& old_of) const {
    const auto [from, to] = dual_.edges[edge];
    return correction_of_[edge] * (old_of[from] - old_of[to]);
  }

  const runtime::Executor& executor_;
  const DualMesh& dual_;
  // The upwind flux along an edge is forward * value at its first - backward * at its second
  // vertex.
  std::vector<double> forward_of_, backward_of_, correction_of_;  // [edge]
  std::vector<double> outflow_of_;                          // [vertex], through the right side
  std::vector<double> low_of_, may_gain_of_, may_lose_of_;  // [vertex], of the step at hand
};

}  // namespace ductile::paper
