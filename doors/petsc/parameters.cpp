#include "parameters.hpp"

#include <algorithm>
#include <optional>

#include "distributed/threads.hpp"
#include "plex_geometry.hpp"

namespace ductile::petsc {

namespace {

template <class Value>
Value parameter(DM dm, PetscErrorCode (*get)(DM, Value*)) {
  Value value{};
  check(get(dm, &value));
  return value;
}

bool is_set(DM dm, PetscErrorCode (*get)(DM, PetscBool*)) {
  return parameter<PetscBool>(dm, get) == PETSC_TRUE;
}

}  // namespace

Parameters parameters_of(DM dm) {
  constexpr double hausdorff_of_nobody = 0.01;
  constexpr double no_smallest = 1e-30, no_largest = 1e30;  // PETSc's defaults
  Parameters parameters;
  auto& adapt = parameters.options.adapt;
  adapt.gradation = parameter<PetscReal>(dm, DMPlexMetricGetGradationFactor);
  adapt.required_gradation = gradation_at_interfaces;
  const double hausdorff = parameter<PetscReal>(dm, DMPlexMetricGetHausdorffNumber);
  if (hausdorff > 0 && (hausdorff != hausdorff_of_nobody || has_geometry(dm)))
    adapt.make.hausdorff_tolerance = hausdorff;
  const double smallest = parameter<PetscReal>(dm, DMPlexMetricGetMinimumMagnitude);
  const double largest = parameter<PetscReal>(dm, DMPlexMetricGetMaximumMagnitude);
  if (smallest > no_smallest) adapt.smallest_size = smallest;
  if (largest < no_largest) adapt.largest_size = largest;
  adapt.insert = !is_set(dm, DMPlexMetricNoInsertion);
  adapt.swap = !is_set(dm, DMPlexMetricNoSwapping);
  adapt.move = !is_set(dm, DMPlexMetricNoMovement);
  adapt.make.lock_boundary = is_set(dm, DMPlexMetricNoSurf);
  const auto passes = parameter<PetscInt>(dm, DMPlexMetricGetNumIterations);
  parameters.options.passes = 2 * static_cast<int>(std::clamp<PetscInt>(passes, 1, 1000));
  parameters.verbosity = static_cast<int>(
      std::clamp<PetscInt>(parameter<PetscInt>(dm, DMPlexMetricGetVerbosity), -1, 10));
  return parameters;
}

int threads_of(const Communicator& comm, DM dm) {
  const char* prefix = nullptr;
  check(PetscObjectGetOptionsPrefix(reinterpret_cast<PetscObject>(dm), &prefix));
  PetscInt threads = 0;
  PetscBool is_given = PETSC_FALSE;
  check(PetscOptionsGetInt(nullptr, prefix, "-dm_ductile_threads", &threads, &is_given));
  return threads_of(
      comm, is_given == PETSC_TRUE ? std::optional(static_cast<int>(threads)) : std::nullopt);
}

}  // namespace ductile::petsc
