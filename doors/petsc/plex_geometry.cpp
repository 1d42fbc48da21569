#include "plex_geometry.hpp"

#include <petscsys.h>

#include <string>

#include "distributed/parts_geometry.hpp"
#include "read_plex.hpp"

namespace ductile::petsc {

namespace {

constexpr const char* of_caller = "ductile_geometry";  // a DMPlex
constexpr const char* made_of_it = "ductile_surface";  // the geometry made from it, composed with
                                                       // the same mesh

/// A Geometry and the data it was made from.
struct MadeGeometry {
  double tolerance;
  std::string facets, elements;  // names of labels
  std::shared_ptr<const meshadapt::Geometry> geometry;
};

PetscErrorCode destroy(void* made) {
  delete static_cast<MadeGeometry*>(made);
  return 0;
}

PetscObject composed(DM dm, const char* name) {
  PetscObject object = nullptr;
  check(PetscObjectQuery(reinterpret_cast<PetscObject>(dm), name, &object));
  return object;
}

/// The geometry made from a mesh earlier, if for the same data; otherwise null.
std::shared_ptr<const meshadapt::Geometry> kept(DM dm, const MadeGeometry& wanted) {
  PetscObject container = composed(dm, made_of_it);
  if (container == nullptr) return nullptr;
  void* pointer = nullptr;
  check(PetscContainerGetPointer(reinterpret_cast<PetscContainer>(container), &pointer));
  const auto& made = *static_cast<const MadeGeometry*>(pointer);
  return made.tolerance == wanted.tolerance && made.facets == wanted.facets &&
                 made.elements == wanted.elements
             ? made.geometry
             : nullptr;
}

void keep(const Communicator& comm, DM dm, const MadeGeometry& made) {
  PetscContainer container = nullptr;
  check(PetscContainerCreate(comm.handle(), &container));
  check(PetscContainerSetPointer(container, new MadeGeometry(made)));
  check(PetscContainerSetUserDestroy(container, destroy));
  check(PetscObjectCompose(reinterpret_cast<PetscObject>(dm), made_of_it,
                           reinterpret_cast<PetscObject>(container)));
  check(PetscContainerDestroy(&container));  // the mesh keeps a reference
}

DMLabel label_named(DM dm, const std::string& name) {
  DMLabel label = nullptr;
  if (!name.empty()) check(DMGetLabel(dm, name.c_str(), &label));
  return label;
}

}  // namespace

bool has_geometry(DM dm) {
  PetscObject object = composed(dm, of_caller);
  if (object == nullptr) return false;
  PetscClassId kind = 0;
  check(PetscObjectGetClassId(object, &kind));
  if (kind != DM_CLASSID)
    throw meshadapt::InputError(std::string(of_caller) +
                                ": expected a DMPlex, found another object");
  return true;
}

std::shared_ptr<const meshadapt::Geometry> geometry_of_plex(
    const Communicator& comm, const runtime::Executor& executor, DM dm, const CarriedLabels& labels,
    const meshadapt::MakeMeshOptions& make) {
  if (!has_geometry(dm)) return nullptr;
  const auto mesh = reinterpret_cast<DM>(composed(dm, of_caller));
  MadeGeometry made{make.hausdorff_tolerance, labels.facets.name, labels.elements.name, nullptr};
  if (auto geometry = kept(mesh, made)) return geometry;
  const PlexPart read = read_plex(comm, mesh,
                                  labels_of(comm, mesh, label_named(mesh, labels.facets.name),
                                            label_named(mesh, labels.elements.name)));
  made.geometry = geometry_of_parts(comm, executor, read.part, make);
  keep(comm, mesh, made);
  return made.geometry;
}

void pass_geometry_on(DM before, DM after) {
  if (PetscObject geometry = composed(before, of_caller))
    check(PetscObjectCompose(reinterpret_cast<PetscObject>(after), of_caller, geometry));
}

}  // namespace ductile::petsc
