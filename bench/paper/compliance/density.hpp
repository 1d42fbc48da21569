/// @file
/// Densities of material between 0 and 1: a projection that turns a smooth density into one that is
/// nearly 0 or 1, and the step of an optimality criterion towards a better design.
#pragma once

#include <span>
#include <vector>

namespace ductile::paper {

/// Moves densities below the threshold towards 0 and those above it towards 1. The sharper, the
/// farther they move; with a sharpness near 0 they stay (Wang, Lazarov & Sigmund, Struct.
/// Multidiscip. Optim. 43, 2011).
struct Projection {
  double sharpness = 1;
  double threshold = 0.5;

  double operator()(double density) const;
  double slope(double density) const;
};

/// The projection of this sharpness after which the densities, each weighted by share_of, have this
/// volume; the threshold is 0 or 1 if none does (volume-preserving projection: Xu, Cai & Cheng,
/// Struct. Multidiscip. Optim. 41, 2010).
struct VolumeGoal {
  double sharpness = 1;
  double volume = 0;
};
Projection projection_of_volume(std::span<const double> density_of,
                                std::span<const double> share_of, const VolumeGoal& goal);

/// Gain and cost of a small increase of the density at each vertex.
struct Derivatives {
  std::vector<double> gain_of{};  ///< [vertex], decrease of compliance per volume
  std::vector<double> cost_of{};  ///< [vertex], increase of volume per volume
};

struct DesignStep {
  double move_limit = 0.2;
  double added_volume = 0;  ///< volume that the step must gain, to first order
};

/// The range of densities in a design; a density of 0 could not grow again.
inline constexpr double least_density = 1e-3;

/// Multiplies each density by the square root of gain over cost (Bendsoe, Structural Optimization
/// 1, 1989), all by one factor that makes the volume right. Returns the largest change.
double improve_design(std::vector<double>& design_of, const Derivatives& derivatives,
                      std::span<const double> share_of, const DesignStep& step);

}  // namespace ductile::paper
