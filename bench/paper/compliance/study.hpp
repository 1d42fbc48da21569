/// @file
/// Study<Dim>: runs optimisations on adapted meshes and on the start mesh, and writes their
/// results: a history, a VTU series and pictures.
#pragma once

#include <string>
#include <vector>

#include "optimiser.hpp"
#include "shared/experiment.hpp"

namespace ductile::paper {

/// Result of an optimisation.
struct Outcome {
  std::string name;
  meshadapt::AnyMesh mesh;
  std::vector<double> density_of;  // [vertex]
  Iteration last;
  double seconds = 0, adapt_seconds = 0, solve_seconds = 0;
};

/// Runs all iterations; writes NAME.csv, NAME.pvd and, in 2D, the strip of frames NAME_frames.png.
template <int Dim>
Outcome optimise(Experiment& experiment, const std::string& name, const Settings& settings);

/// Draws structures side by side, and in 2D the meshes below them.
template <int Dim>
void draw_outcomes(Experiment& experiment, const std::string& name,
                   const std::vector<Outcome>& outcomes);

extern template Outcome optimise<2>(Experiment&, const std::string&, const Settings&);
extern template Outcome optimise<3>(Experiment&, const std::string&, const Settings&);
template <>
void draw_outcomes<2>(Experiment& experiment, const std::string& name,
                      const std::vector<Outcome>& outcomes);
template <>
void draw_outcomes<3>(Experiment& experiment, const std::string& name,
                      const std::vector<Outcome>& outcomes);

}  // namespace ductile::paper
