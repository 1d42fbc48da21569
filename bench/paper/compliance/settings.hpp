/// @file
/// Settings of an optimisation: the problem, the path to its solution, and the meshes on the way.
/// Lengths are in units of the cantilever's length, stiffness in units of the solid's.
#pragma once

namespace ductile::paper {

/// The cantilever is 1 long, `height` high and, in 3D, `width` wide. It is clamped at x = 0; a
/// force of 1 pulls down the middle fifth of the other end.
struct Problem {
  double volume_fraction = 0.5;
  double minimum_length = 0.01;  ///< minimum thickness of bars and holes
  double penalty = 3;            ///< stiffness is density^penalty (SIMP)
  double void_stiffness = 1e-6;  ///< stiffness where there is no material
  double poisson = 0.3;
};

inline constexpr double height = 0.5;
inline constexpr double width = 0.25;

struct Path {
  int iterations = 120;
  double move_limit = 0.2;     ///< largest change of a density in an iteration
  double last_sharpness = 16;  ///< final sharpness; doubles from 1 on, see sharpness_at
  double first_length = 0;     ///< initial filter length if above minimum_length, see length_at
};

/// Sharpness doubles in equal steps; the last third of the iterations has the last one.
double sharpness_at(const Path& path, int iteration);
/// The length of the filter: shrinks by the same factor whenever sharpness doubles, from the first
/// one to the minimum length.
double length_at(const Path& path, double minimum_length, int iteration);

struct Adaptation {
  double elements = 0;    ///< approximate number in adapted meshes; 0: the start mesh is kept
  int interval = 5;       ///< iterations between adaptations
  double smallest = 0.1;  ///< edge length, in units of the filter's length
  double largest = 0.1;   ///< edge length, as the height of the cantilever is 0.5
  double anisotropy = 10;
  double gradation = 1.5;
};

struct Settings {
  int cells = 50;  ///< of the start mesh, across the height; a multiple of 10
  Problem problem;
  Path path;
  Adaptation adaptation;
};

}  // namespace ductile::paper
