/// @file
/// Darcy's law: div u = 0, u = -grad(p) / viscosity, by linear finite elements and CHOLMOD. The
/// inflow on the left is given, p = 0 on the right, and no flow crosses the upper and lower sides.
/// The resulting fluxes between the cells of a DualMesh balance at every vertex.
#pragma once

#include <Eigen/CholmodSupport>
#include <cmath>
#include <vector>

#include "fingering/dual_mesh.hpp"

namespace ductile::paper {

/// Viscosity e^(R (1 - saturation)): 1 for the injected fluid, e^R for the displaced one.
struct Fluids {
  double log_viscosity_ratio = 2;  ///< R
  double diffusivity = 0.0004;     ///< for width and speed of the inflow of 1
};

/// 1 / viscosity.
inline double mobility(const Fluids& fluids, double saturation) {
  return std::exp(fluids.log_viscosity_ratio * (saturation - 1));
}

/// Flow rates; those through the left side are DualMesh::inflow_of.
struct Flow {
  std::vector<double> pressure_of;  // [vertex]
  std::vector<double> flux_of;      // [edge], from its first vertex to its second
  std::vector<double> outflow_of;   // [index into outlet], through the right side
};

class PressureSolver {
 public:
  /// Finds the order of elimination, once for a mesh. Keeps a reference to it.
  explicit PressureSolver(const DualMesh& dual);

  /// Throws Error if the system has no solution. Thread safety: one caller.
  Flow solve(const Fluids& fluids, const std::vector<double>& saturation_of);

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix assemble(const std::vector<double>& mobility_of) const;
  void add_velocity(Flow& flow, const std::vector<double>& mobility_of) const;

  const DualMesh& dual_;
  std::vector<int> unknown_of_;  // [vertex], -1 at the outlet
  int unknown_count_ = 0;
  Eigen::CholmodSupernodalLLT<Matrix> factors_;
};

}  // namespace ductile::paper
