/// @file
/// March: a mesh that follows the solution from time step to time step. At each, the solution is
/// sampled on the mesh as it is, its Hessian recovered, the metric scaled to a complexity, and the
/// mesh adapted. Some steps are taken on several numbers of threads, from the same mesh, and timed.
#pragma once

#include <array>
#include <functional>
#include <numeric>
#include <vector>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::paper {

/// Requirements on meshes.
struct MeshGoal {
  double elements = 0;       ///< approximate number
  double smallest = 1e-5;    ///< size; the jump would ask for 0
  double largest = 0.2;      ///< size
  double anisotropy = 1000;  ///< the longest size over the shortest
};

/// One adaptation and the time for its metric.
struct FollowedMesh {
  meshadapt::AdaptedMesh adapted;
  double metric_seconds = 0;
};
FollowedMesh follow(const runtime::Executor& executor, const meshadapt::AnyMesh& mesh,
                    const MeshGoal& goal, double phase);

/// Seconds, summed over time steps.
struct KernelSeconds {
  std::array<double, meshadapt::kernels.size()> kernels{};
  double other = 0;   ///< set-up and renumbering in adapt()
  double metric = 0;  ///< sampling, recovery of the Hessian, scaling
  double adapt() const { return std::accumulate(kernels.begin(), kernels.end(), other); }
};

struct March {
  MeshGoal goal;
  int steps = 50;              ///< number of steps in a period
  int until = 50;              ///< the last step to take
  int timed = 10;              ///< number of timed steps, spread evenly
  std::vector<int> threads{};  ///< numbers of threads for timed steps, besides the executor's
  /// Called with the result of each step.
  std::function<void(int step, double phase, const meshadapt::AnyMesh& mesh)> look{};
};

/// Times of steps on one number of threads.
struct TimedSteps {
  int threads = 0;
  int steps = 0;
  KernelSeconds seconds{};
};

struct MarchReport {
  double mean_elements = 0;
  TimedSteps all;                   ///< every step, on the executor's threads
  std::vector<TimedSteps> timed{};  ///< the same steps on each number of threads, fewest first
  bool identical = true;            ///< meshes and metrics did not depend on threads
};

/// Adapts the mesh to the solution at each phase in order. The goal is adjusted from phase to phase
/// until meshes have the wanted number of elements: at the jump of psi the metric varies too much
/// for complexity_of_elements() to predict it.
meshadapt::AnyMesh fitted_mesh(const runtime::Executor& executor, meshadapt::AnyMesh mesh,
                               MeshGoal& goal, const std::vector<double>& phases);

/// Marches through the period, with one complexity, after three steps that fit mesh and complexity
/// and are not counted.
MarchReport march(const runtime::Executor& executor, meshadapt::AnyMesh mesh, const March& march);

/// Number of triangles, or of tetrahedra in 3D.
std::size_t element_count(const meshadapt::AnyMesh& mesh);

/// The start mesh of the unit square or cube, with this many cells along each axis.
meshadapt::AnyMesh start_mesh_of(int dimension, int cells);
/// The start mesh with about this many elements.
meshadapt::AnyMesh start_mesh(int dimension, double elements);

}  // namespace ductile::paper
