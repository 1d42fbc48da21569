/// @file
/// Helpers for PETSc: error codes as exceptions, strata, labels.
#pragma once

#include <petscdmlabel.h>
#include <petscdmplex.h>

#include <string>

#include "distributed/communicator.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::petsc {

using namespace distributed;

/// Throws Error for an error code; PETSc has already printed where it occurred.
inline void check(PetscErrorCode code) {
  if (code != 0) throw meshadapt::Error("PETSc has failed with error " + std::to_string(code));
}

/// A range of points; the end is exclusive.
struct Stratum {
  PetscInt begin = 0, end = 0;
  bool has(PetscInt point) const { return point >= begin && point < end; }
  PetscInt size() const { return end - begin; }
};

inline Stratum stratum_of_height(DM dm, PetscInt height) {
  Stratum stratum;
  check(DMPlexGetHeightStratum(dm, height, &stratum.begin, &stratum.end));
  return stratum;
}

inline Stratum vertices_of(DM dm) {
  Stratum stratum;
  check(DMPlexGetDepthStratum(dm, 0, &stratum.begin, &stratum.end));
  return stratum;
}

/// A label that is kept by the adaptation; it may not exist.
struct CarriedLabel {
  std::string name;         ///< empty if no rank has it
  DMLabel label = nullptr;  ///< of the old mesh; null if this rank has none

  /// The value of a point, or `otherwise` if it has none. Throws InputError if it needs more than
  /// 32 bits.
  std::int32_t value_at(PetscInt point, std::int32_t otherwise) const;
};

struct CarriedLabels {
  CarriedLabel facets, elements, vertices, edges;
};

/// The labels given to the adaptor, otherwise "Face Sets" and "Cell Sets", and always "Vertex Sets"
/// and in 3D "Edge Sets". A name used several times is kept once for each. Collective.
CarriedLabels labels_of(const Communicator& comm, DM dm, DMLabel facets, DMLabel elements);

}  // namespace ductile::petsc
