/// @file
/// What is used of PETSc everywhere: codes of errors as exceptions, strata, labels.
#pragma once

#include <petscdmlabel.h>
#include <petscdmplex.h>

#include <string>

#include "communicator.hpp"
#include "ductile/meshadapt/error.hpp"

namespace ductile::petsc {

/// Throws Error for the code of an error, of which PETSc has told by itself where it was.
inline void check(PetscErrorCode code) {
  if (code != 0) throw meshadapt::Error("PETSc has failed with error " + std::to_string(code));
}

/// Points from begin to end, without end.
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

/// A label that is carried along; it may not be there.
struct CarriedLabel {
  std::string name;         ///< empty if no rank has it
  DMLabel label = nullptr;  ///< of the mesh before; null where a rank has none

  /// The value of a point that has one, else `otherwise`. Throws InputError if it needs more than
  /// 32 bits.
  std::int32_t value_at(PetscInt point, std::int32_t otherwise) const;
};

struct CarriedLabels {
  CarriedLabel facets, elements, vertices, edges;
};

/// The labels that an adaptor is given, or else "Face Sets" and "Cell Sets", and "Vertex Sets", and
/// in 3D "Edge Sets". A name that is the same in all is carried once for each. Collective.
CarriedLabels labels_of(const Communicator& comm, DM dm, DMLabel facets, DMLabel elements);

}  // namespace ductile::petsc
