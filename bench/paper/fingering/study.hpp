/// @file
/// The runs of the experiment, how far two of them lie apart, and what a uniform mesh would need to
/// come as near to a reference as an adapted one does.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "fingering/simulation.hpp"

namespace ductile::paper {

/// One run from the start to a time.
struct RunOptions {
  int cells = 32;            ///< of the uniform mesh to start with, from bottom to top
  double end = 1;            ///< time
  double interval = 0.0025;  ///< between two pressures
  int adapt_every = 0;       ///< intervals; 0: never
  AdaptGoal goal = {};       ///< `ahead` becomes the time between adaptations
};

/// Called at the start and after each interval.
using Watch = std::function<void(Simulation&)>;

/// The case: two squares, a sharp front on the left that is a little wavy.
std::unique_ptr<Simulation> run_case(const runtime::Executor& executor, const RunOptions& options,
                                     const Watch& watch);

/// What a run came to, beside a reference.
struct Outcome {
  bool adapted = false;
  double triangles = 0;  ///< mean over time
  double error = 0;      ///< integral of the difference of saturations at the end
  Seconds seconds = {};  ///< without output
  Seconds solving = {};  ///< of these, for pressure and transport
  int steps = 0;
};

Outcome compare(const runtime::Executor& executor, const Simulation& run,
                const Simulation& reference);

/// The saturation along the line of this x, by y: where the edges of the mesh cross it.
std::vector<std::pair<double, double>> profile(const Simulation& run, double x);

/// How far the fingers reach, and how many there are.
struct Fingers {
  double root = 0, tip = 0;  ///< least and largest x of saturation 0.5
  int count = 0;             ///< along the line half-way between them
};
Fingers fingers(const Simulation& run);

/// What uniform meshes need for an error: triangles and time as powers of the error through the
/// two of `uniform` that are nearest to it.
Outcome uniform_for_error(const std::vector<Outcome>& uniform, double error);

}  // namespace ductile::paper
