/// @file
/// HelmholtzFilter<Dim>: makes a field smooth over a given length: the solution s of
///   s - r^2 div grad s = f, without flow through the boundary, r = length / (2 sqrt 3)
/// (Lazarov & Sigmund, Int. J. Numer. Methods Eng. 86, 2011). Linear elements, lumped mass; the
/// integral of f is kept.
#pragma once

#include <vector>

#include "ductile/meshadapt/fixed_mesh.hpp"
#include "linear_solver.hpp"

namespace ductile::paper {

template <int Dim>
class HelmholtzFilter {
 public:
  /// Keeps a reference to `mesh`.
  HelmholtzFilter(const meshadapt::FixedMesh<Dim>& mesh, double length);

  /// Returns smoothed values at the vertices.
  std::vector<double> smooth(const std::vector<double>& value_of) const;
  /// Smooths a field given by its integrals with the vertices' hat functions, such as a derivative
  /// with respect to values at the vertices.
  std::vector<double> smooth_integrated(const std::vector<double>& integral_of) const;

 private:
  const meshadapt::FixedMesh<Dim>& mesh_;
  LinearSolver<Dim> solver_;
};

extern template class HelmholtzFilter<2>;
extern template class HelmholtzFilter<3>;

}  // namespace ductile::paper
