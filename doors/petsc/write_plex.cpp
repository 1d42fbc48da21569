#include "write_plex.hpp"

#include <petscsf.h>

#include <algorithm>
#include <array>
#include <vector>

namespace ductile::petsc {

namespace {

template <int Dim>
class Writer {
 public:
  Writer(const Communicator& comm, const AdaptedParts& parts)
      : comm_(comm), part_(parts.part), own_(parts.own) {}

  DM write(const CarriedLabels& labels) {
    create();
    write_labels(labels);
    return dm_;
  }

 private:
  const auto& elements() const { return meshadapt::elements_in<Dim>(part_.mesh); }

  /// Creates the mesh from the corners of this rank's elements and the positions of its vertices.
  void create() {
    std::vector<PetscInt> corners;
    std::vector<PetscReal> places;
    comm_.on_all([&] {
      for (const auto& element : elements().vertices) {
        for (const VertexId v : element)
          corners.push_back(static_cast<PetscInt>(part_.number_of[v]));
        if (Dim == 3) std::swap(corners[corners.size() - 3], corners[corners.size() - 2]);
      }
      places = places_of_own();
    });
    PetscSF sf = nullptr;
    check(DMPlexCreateFromCellListParallelPetsc(
        comm_.handle(), Dim, static_cast<PetscInt>(elements().size()), static_cast<PetscInt>(own_),
        PETSC_DECIDE, Dim + 1, PETSC_TRUE, corners.data(), Dim, places.data(), &sf, nullptr, &dm_));
    check(PetscSFDestroy(&sf));
  }

  std::vector<PetscReal> places_of_own() const {
    std::vector<PetscReal> places(static_cast<std::size_t>(own_ * Dim));
    for (VertexId v = 0; v < part_.number_of.size(); ++v) {
      const std::int64_t at = part_.number_of[v] - first_;
      if (at < 0 || at >= own_) continue;
      std::copy_n(&part_.mesh.coordinates[static_cast<std::size_t>(v) * Dim], Dim,
                  &places[static_cast<std::size_t>(at * Dim)]);
    }
    return places;
  }

  /// Numbers points: PETSc sorts the vertices of a rank by number.
  void number_points() {
    point_of_.resize(part_.number_of.size());
    PetscInt next = vertices_of(dm_).begin;
    for (const VertexId v : by_number(part_)) point_of_[v] = next++;
  }

  void write_labels(const CarriedLabels& labels) {
    DMLabel of_elements = nullptr, of_facets = nullptr, of_vertices = nullptr, of_edges = nullptr;
    create_label(labels.elements, of_elements);
    create_label(labels.facets, of_facets);
    create_label(labels.vertices, of_vertices);
    create_label(labels.edges, of_edges);
    comm_.on_all([&] {
      number_points();
      for (std::size_t e = 0; e < elements().size(); ++e)
        set(of_elements, static_cast<PetscInt>(e), elements().reference[e]);
      for (VertexId v = 0; v < point_of_.size(); ++v)
        set(of_vertices, point_of_[v], part_.mesh.vertex_reference[v]);
      set_listed(of_facets, meshadapt::facets_in<Dim>(part_.mesh));
      if (Dim == 3) set_listed(of_edges, part_.mesh.edges);
    });
  }

  template <int Corners>
  void set_listed(DMLabel label, const meshadapt::Cells<Corners>& cells) const {
    if (label == nullptr) return;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells.reference[i] != unlabelled)
        set(label, point_between(cells.vertices[i]), cells.reference[i]);
  }

  /// Creates a label on all ranks if any rank had it.
  void create_label(const CarriedLabel& before, DMLabel& label) {
    if (before.name.empty()) return;
    check(DMCreateLabel(dm_, before.name.c_str()));
    check(DMGetLabel(dm_, before.name.c_str(), &label));
    PetscInt none = -1;
    if (before.label != nullptr) check(DMLabelGetDefaultValue(before.label, &none));
    check(DMLabelSetDefaultValue(label, none));
  }

  static void set(DMLabel label, PetscInt point, std::int32_t value) {
    if (label != nullptr && value != unlabelled) check(DMLabelSetValue(label, point, value));
  }

  /// The facet or edge between some vertices.
  template <std::size_t N>
  PetscInt point_between(const std::array<VertexId, N>& vertices) const {
    constexpr auto size = static_cast<PetscInt>(N);
    std::array<PetscInt, N> corners;
    for (std::size_t i = 0; i < N; ++i) corners[i] = point_of_[vertices[i]];
    PetscInt count = 0;
    const PetscInt* joined = nullptr;
    check(DMPlexGetFullJoin(dm_, size, corners.data(), &count, &joined));
    const PetscInt point = count == 1 ? joined[0] : -1;
    check(DMPlexRestoreJoin(dm_, size, corners.data(), &count, &joined));
    if (point < 0)
      throw meshadapt::Error("a facet or an edge is missing in the mesh that PETSc has made");
    return point;
  }

  const Communicator& comm_;
  const Part& part_;
  std::int64_t own_;
  std::int64_t first_ = comm_.sum_before(own_);
  DM dm_ = nullptr;
  std::vector<PetscInt> point_of_;  // [vertex]
};

}  // namespace

DM write_plex(const Communicator& comm, const AdaptedParts& parts, const CarriedLabels& labels) {
  return parts.part.mesh.dimension == 2 ? Writer<2>(comm, parts).write(labels)
                                        : Writer<3>(comm, parts).write(labels);
}

}  // namespace ductile::petsc
