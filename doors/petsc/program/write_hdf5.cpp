#include <petscviewer.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string>

#include "plex.hpp"
#include "write_hdf5.hpp"
#include "write_plex.hpp"

namespace ductile::petsc {

namespace {

namespace fs = std::filesystem;
using meshadapt::NamedField;

/// Owns a PETSc object.
template <class Object, PetscErrorCode (*destroy)(Object*)>
class Held {
 public:
  Held() = default;
  ~Held() { destroy(&object_); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  Object* operator&() { return &object_; }  // NOLINT: as PETSc's functions take it
  operator Object() const { return object_; }

 private:
  Object object_ = nullptr;
};
using HeldDM = Held<DM, DMDestroy>;
using HeldVec = Held<Vec, VecDestroy>;
using HeldSection = Held<PetscSection, PetscSectionDestroy>;
using HeldViewer = Held<PetscViewer, PetscViewerDestroy>;

/// order is [vertex or cell of the DMPlex], its index in the part.
void write_field(DM plex, PetscViewer viewer, const NamedField& field,
                 const std::vector<std::uint32_t>& order, int dimension) {
  const PetscInt each = component_count(field.type, dimension);
  const Stratum points =
      field.place == NamedField::Place::vertices ? vertices_of(plex) : stratum_of_height(plex, 0);
  HeldDM dm;
  HeldSection section;
  HeldVec local, global;
  check(DMClone(plex, &dm));
  check(PetscSectionCreate(PetscObjectComm(reinterpret_cast<PetscObject>(plex)), &section));
  check(PetscSectionSetNumFields(section, 1));
  check(PetscSectionSetFieldName(section, 0, field.name.c_str()));
  check(PetscSectionSetFieldComponents(section, 0, each));
  check(PetscSectionSetChart(section, points.begin, points.end));
  for (PetscInt p = points.begin; p < points.end; ++p) {
    check(PetscSectionSetDof(section, p, each));
    check(PetscSectionSetFieldDof(section, p, 0, each));
  }
  check(PetscSectionSetUp(section));
  check(DMSetLocalSection(dm, section));
  check(DMCreateLocalVector(dm, &local));
  PetscScalar* values = nullptr;
  check(VecGetArray(local, &values));
  for (std::size_t i = 0; i < order.size(); ++i)
    std::copy_n(&field.values[order[i] * static_cast<std::size_t>(each)], each,
                values + static_cast<std::ptrdiff_t>(i) * each);
  check(VecRestoreArray(local, &values));
  check(DMCreateGlobalVector(dm, &global));
  check(PetscObjectSetName(reinterpret_cast<PetscObject>(static_cast<Vec>(global)),
                           field.name.c_str()));
  check(DMLocalToGlobal(dm, local, INSERT_VALUES, global));
  check(VecView(global, viewer));
}

/// A copy of the parts with references as labels.
AdaptedParts with_references(const DistributedResult& result) {
  AdaptedParts parts = result.parts;
  for (std::int32_t& reference : parts.part.mesh.vertex_reference)
    if (reference != unlabelled)
      reference = result.kept.vertices[static_cast<std::size_t>(reference)].reference;
  AnyMesh& mesh = parts.part.mesh;
  auto& of_elements = mesh.dimension == 2 ? mesh.triangles.reference : mesh.tetrahedra.reference;
  restore_references(mesh.dimension == 2 ? mesh.edges.reference : mesh.triangles.reference,
                     result.kept.facets);
  restore_references(of_elements, result.kept.elements);
  return parts;
}

}  // namespace

void write_hdf5(const Communicator& comm, const fs::path& path, const DistributedResult& result) {
  CarriedLabels labels;
  labels.facets.name = "Face Sets";
  labels.elements.name = "Cell Sets";
  labels.vertices.name = "Vertex Sets";
  if (result.parts.part.mesh.dimension == 3) labels.edges.name = "Edge Sets";
  const AdaptedParts parts = comm.on_all([&] { return with_references(result); });
  const auto vertices = comm.on_all([&] { return by_number(parts.part); });  // PETSc sorts them
  std::vector<std::uint32_t> cells(parts.part.element_count());  // in the order of the part
  std::iota(cells.begin(), cells.end(), 0U);
  const std::string temporary = path.string() + ".ductile-tmp";
  {
    HeldDM plex;
    HeldViewer viewer;
    *&plex = write_plex(comm, parts, labels);
    check(PetscObjectSetName(reinterpret_cast<PetscObject>(static_cast<DM>(plex)), "mesh"));
    check(PetscViewerCreate(comm.handle(), &viewer));
    check(PetscViewerSetType(viewer, PETSCVIEWERHDF5));
    check(PetscViewerFileSetMode(viewer, FILE_MODE_WRITE));
    check(PetscViewerFileSetName(viewer, temporary.c_str()));
    check(DMView(plex, viewer));
    for (const NamedField& field : result.fields)
      write_field(plex, viewer, field,
                  field.place == NamedField::Place::vertices ? vertices : cells,
                  parts.part.mesh.dimension);
  }
  comm.on_all([&] {
    if (comm.rank() == 0) fs::rename(temporary, path);
  });
}

}  // namespace ductile::petsc
