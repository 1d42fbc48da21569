#include <limits>

#include "plex.hpp"

namespace ductile::petsc {

namespace {

/// The label with this name, if any rank has it.
CarriedLabel label_named(const Communicator& comm, DM dm, const char* name) {
  CarriedLabel carried;
  check(DMGetLabel(dm, name, &carried.label));
  if (comm.largest(carried.label != nullptr ? 1 : 0) == 1) carried.name = name;
  return carried;
}

CarriedLabel given(const Communicator& comm, DM dm, DMLabel label, const char* otherwise) {
  if (label == nullptr) return label_named(comm, dm, otherwise);
  const char* name = nullptr;
  check(PetscObjectGetName(reinterpret_cast<PetscObject>(label), &name));
  return {name, label};
}

}  // namespace

std::int32_t CarriedLabel::value_at(PetscInt point, std::int32_t otherwise) const {
  if (label == nullptr) return otherwise;
  PetscInt value = 0, none = -1;
  check(DMLabelGetDefaultValue(label, &none));
  check(DMLabelGetValue(label, point, &value));
  if (value == none) return otherwise;
  using Range = std::numeric_limits<std::int32_t>;
  if (value <= Range::min() || value > Range::max())
    throw meshadapt::InputError("label " + name + ": expected values of 32 bits, found " +
                                std::to_string(value));
  return static_cast<std::int32_t>(value);
}

CarriedLabels labels_of(const Communicator& comm, DM dm, DMLabel facets, DMLabel elements) {
  PetscInt dimension = 0;
  check(DMGetDimension(dm, &dimension));
  return {given(comm, dm, facets, "Face Sets"), given(comm, dm, elements, "Cell Sets"),
          label_named(comm, dm, "Vertex Sets"),
          dimension == 3 ? label_named(comm, dm, "Edge Sets") : CarriedLabel()};
}

}  // namespace ductile::petsc
