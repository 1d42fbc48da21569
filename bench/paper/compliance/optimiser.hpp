/// @file
/// Optimiser<Dim>: searches for the stiffest cantilever of a given volume by the density method.
/// The design, a density at each vertex, is smoothed by the filter, projected towards 0 and 1, and
/// analysed; the derivative is propagated back. From time to time the mesh is adapted to the
/// densities and the derivative, and the design is transferred with its integral.
#pragma once

#include <memory>
#include <vector>

#include "density.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"
#include "elasticity.hpp"
#include "helmholtz_filter.hpp"
#include "settings.hpp"

namespace ductile::paper {

/// Results of one iteration.
struct Iteration {
  int number = 0;
  std::size_t elements = 0;
  double sharpness = 0;
  double length = 0;  ///< of the filter
  double compliance = 0;
  double volume_fraction = 0;
  double change = 0;  ///< largest change of a density
  double adapt_seconds = 0, solve_seconds = 0, seconds = 0;
};

template <int Dim>
class Optimiser {
 public:
  /// Keeps references to both.
  Optimiser(const runtime::Executor& executor, const Settings& settings);

  /// Adapts the mesh if it is due, analyses the design and improves it. Thread safety: one thread.
  Iteration iterate();

  const meshadapt::AnyMesh& mesh() const { return any_; }
  /// Results of the last iteration, [vertex]: the density of material, and the derivative.
  const std::vector<double>& density() const { return density_of_; }
  const std::vector<double>& derivative() const { return derivatives_.gain_of; }
  std::size_t element_count() const { return fixed_->element_count(); }

 private:
  void use(meshadapt::AnyMesh any);
  void use_filter(double length);
  void adapt_mesh();
  std::vector<double> project(double sharpness);
  double analyse();
  void differentiate(const std::vector<double>& smooth_of);

  const runtime::Executor& executor_;
  const Settings& settings_;
  int iteration_ = 0;
  double length_ = 0;  ///< of the filter; 0: there is none for this mesh
  meshadapt::AnyMesh any_;
  std::unique_ptr<meshadapt::FixedMesh<Dim>> fixed_;
  std::unique_ptr<Elasticity<Dim>> elasticity_;
  std::unique_ptr<HelmholtzFilter<Dim>> filter_;
  Projection projection_;
  double domain_volume_ = 0, missing_volume_ = 0;
  // [vertex]
  std::vector<double> design_of_, density_of_;
  std::vector<meshadapt::Vector<Dim>> displacement_of_;
  Derivatives derivatives_;
};

/// Densities and their mesh. It refers to both, so use it for passing arguments only.
template <int Dim>
struct DensityOnMesh {
  const meshadapt::AnyMesh& mesh;
  const std::vector<double>& density_of;
};
struct Judgement {
  double compliance = 0;
  double volume_fraction = 0;
};
/// The compliance of the densities on another mesh of the cantilever, for instance a finer one.
template <int Dim>
Judgement judge(const runtime::Executor& executor, const DensityOnMesh<Dim>& found,
                const meshadapt::AnyMesh& fine, const Problem& problem);

extern template class Optimiser<2>;
extern template class Optimiser<3>;
extern template Judgement judge(const runtime::Executor&, const DensityOnMesh<2>&,
                                const meshadapt::AnyMesh&, const Problem&);
extern template Judgement judge(const runtime::Executor&, const DensityOnMesh<3>&,
                                const meshadapt::AnyMesh&, const Problem&);

}  // namespace ductile::paper
