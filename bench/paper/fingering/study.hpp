/// @file
/// The runs of the experiment, the difference between two of them, and the cost of a uniform mesh
/// that comes as close to a reference as an adapted one.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "fingering/simulation.hpp"

namespace ductile::paper {

/// Options of one run.
struct RunOptions {
  int cells = 32;            ///< from bottom to top in the uniform start mesh
  double end = 1;            ///< time
  double interval = 0.0025;  ///< time between two pressure solves
  int adapt_every = 0;       ///< intervals; 0: never
  AdaptGoal goal = {};       ///< `ahead` becomes the time between adaptations
};

/// Called at the start and after each interval.
using Watch = std::function<void(Simulation&)>;

/// The case: a domain of two squares, with a sharp, slightly wavy front on the left.
std::unique_ptr<Simulation> run_case(const runtime::Executor& executor, const RunOptions& options,
                                     const Watch& watch);

/// Result of a run, compared with a reference.
struct Outcome {
  bool adapted = false;
  double triangles = 0;  ///< mean over time
  double error = 0;      ///< integral of the difference of saturations at the end
  Seconds seconds = {};  ///< excludes output
  Seconds solving = {};  ///< the part for pressure and transport
  int steps = 0;
};

Outcome compare(const runtime::Executor& executor, const Simulation& run,
                const Simulation& reference);

/// Saturation along the line of this x, by y, at the intersections with edges of the mesh.
std::vector<std::pair<double, double>> profile(const Simulation& run, double x);

/// How far the fingers reach, and how many there are.
struct Fingers {
  double root = 0, tip = 0;  ///< least and largest x of saturation 0.5
  int count = 0;             ///< along the line half-way between them
};
Fingers fingers(const Simulation& run);

/// Cost of uniform meshes for this error: triangles and time as powers of the error through the two
/// nearest of `uniform`.
Outcome uniform_for_error(const std::vector<Outcome>& uniform, double error);

}  // namespace ductile::paper
