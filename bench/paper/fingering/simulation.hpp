/// @file
/// Simulation: a fluid displaces a more viscous one from left to right. In each interval of time
/// the pressure is computed for the saturation at its start, and the saturation is transported to
/// its end. Between intervals the mesh may be adapted to both, and the saturation projected to it.
/// The metric covers where the front will be until the next adaptation.
#pragma once

#include <memory>
#include <vector>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/executor.hpp"
#include "fingering/dual_mesh.hpp"
#include "fingering/pressure.hpp"
#include "fingering/transport.hpp"

namespace ductile::paper {

/// Saturation at a point at the start.
using Start = double (*)(const meshadapt::Vector<2>&);

/// Goals of adaptation: interpolation errors (L2 norm over the domain, whose area is 2) of the
/// saturation, and of the pressure relative to its largest value.
struct AdaptGoal {
  double saturation_error = 0.002;
  double pressure_error = 0.002;
  double smallest_size = 0.001;
  double largest_size = 0.1;
  double ahead = 0;  ///< time from now that the metric must cover
};

/// Seconds: of the clock on the wall, and of all processors together.
struct Seconds {
  double wall = 0, processor = 0;
  friend Seconds operator+(const Seconds& a, const Seconds& b) {
    return {a.wall + b.wall, a.processor + b.processor};
  }
};

/// Times by phase; transfer includes preparations for a new mesh.
struct Timings {
  Seconds pressure, transport, adaptation, transfer;
  Seconds solving() const { return pressure + transport; }
  Seconds total() const { return solving() + adaptation + transfer; }
};

class Simulation {
 public:
  Simulation(const runtime::Executor& executor, const Fluids& fluids, const AnyMesh& mesh,
             Start start);

  /// Adapts the mesh to the initial state, several times, and samples that anew.
  void adapt_to_start(const AdaptGoal& goal, Start start);

  void adapt(const AdaptGoal& goal);
  void advance(double interval);

  const AnyMesh& mesh() const { return mesh_; }
  const DualMesh& dual() const { return *dual_; }
  const std::vector<double>& saturation() const { return saturation_of_; }
  /// Computes the flow unless it is current.
  const std::vector<double>& pressure() {
    find_flow();
    return flow_.pressure_of;
  }
  double time() const { return time_; }
  const Timings& timings() const { return timings_; }

  /// Mean over time of the number of triangles.
  double mean_triangles() const { return triangle_time_ / time_; }
  bool adapted() const { return adaptations_ > 0; }
  /// Number of steps of the transport.
  int steps() const { return steps_; }

  /// Integral over the mesh of the linear function with these values at the vertices.
  double integral(const std::vector<double>& value_of) const;
  /// The integral of the saturation.
  double mass() const { return integral(saturation_of_); }
  /// Relative error of the mass balance: the mass compared with the initial mass plus inflow minus
  /// outflow.
  double mass_error() const;
  /// Largest relative change of the mass in a projection to a new mesh.
  double transfer_error() const { return transfer_error_; }
  /// Largest amount by which the saturation has left the range 0 to 1.
  double overshoot() const { return overshoot_; }

 private:
  void take_mesh(AnyMesh mesh);
  std::vector<meshadapt::Metric<2>> wanted_metric(const AdaptGoal& goal);
  std::vector<meshadapt::Metric<2>> carried(const std::vector<meshadapt::Metric<2>>& metric_of,
                                            double time) const;
  AnyMesh adapted_mesh(const AdaptGoal& goal);
  void sample(Start start);
  void find_flow();
  void watch_bounds();

  const runtime::Executor& executor_;
  Fluids fluids_;
  AnyMesh mesh_;
  std::unique_ptr<DualMesh> dual_;  // referred to by solver_
  std::unique_ptr<PressureSolver> solver_;
  std::vector<double> saturation_of_;  // [vertex]
  Flow flow_;                          // of saturation_of_, if flow_is_current_
  bool flow_is_current_ = false;
  Timings timings_;
  Ledger ledger_;
  double time_ = 0, triangle_time_ = 0, start_mass_ = 0;
  double transfer_error_ = 0, overshoot_ = 0;
  int steps_ = 0, adaptations_ = 0;
};

}  // namespace ductile::paper
