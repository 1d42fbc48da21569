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

  /// Values at the vertices to smooth values at the vertices.
  std::vector<double> smooth(const std::vector<double>& value_of) const;
  /// The same of f times each vertex's hat function, integrated: what a derivative by the values
  /// at the vertices is.
  std::vector<double> smooth_integrated(const std::vector<double>& integral_of) const;

 private:
  const meshadapt::FixedMesh<Dim>& mesh_;
  LinearSolver<Dim> solver_;
};

extern template class HelmholtzFilter<2>;
extern template class HelmholtzFilter<3>;

}  // namespace ductile::paper
