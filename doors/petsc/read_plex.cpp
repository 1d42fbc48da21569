#include "read_plex.hpp"

#include <petscsf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace ductile::petsc {

namespace {

using meshadapt::InputError;

class Reader {
 public:
  Reader(DM dm, const CarriedLabels& labels, const PetscInt* number_of)
      : dm_(dm),
        labels_(labels),
        number_of_(number_of),
        cells_(stratum_of_height(dm, 0)),
        vertices_(vertices_of(dm)),
        is_ghost_(static_cast<std::size_t>(cells_.size()), 0),
        local_of_(static_cast<std::size_t>(vertices_.size()), meshadapt::none) {
    PetscInt dimension = 0;
    check(DMGetDimension(dm, &dimension));
    result_.part = empty_part(static_cast<int>(dimension));
    result_.part.mesh.name = "mesh";
  }

  PlexPart read() {
    expect_simplices();
    find_ghosts();
    if (result_.part.mesh.dimension == 2)
      read_in<2>();
    else
      read_in<3>();
    return std::move(result_);
  }

 private:
  void expect_simplices() const {
    PetscInt dimension = 0, of_space = 0;
    check(DMGetDimension(dm_, &dimension));
    check(DMGetCoordinateDim(dm_, &of_space));
    if (dimension != of_space || (dimension != 2 && dimension != 3))
      throw InputError("mesh: expected dimension 2 in the plane or 3 in space, found " +
                       std::to_string(dimension) + " in " + std::to_string(of_space));
    Vec of_cells = nullptr;
    check(DMGetCellCoordinatesLocalNoncollective(dm_, &of_cells));
    if (of_cells != nullptr)
      throw InputError("mesh: expected one that is not periodic, found coordinates of cells");
    const DMPolytopeType simplex = dimension == 2 ? DM_POLYTOPE_TRIANGLE : DM_POLYTOPE_TETRAHEDRON;
    for (PetscInt c = cells_.begin; c < cells_.end; ++c) {
      DMPolytopeType type = DM_POLYTOPE_UNKNOWN;
      check(DMPlexGetCellType(dm_, c, &type));
      if (type != simplex)
        throw InputError("mesh: expected triangles or tetrahedra only, found cell " +
                         std::to_string(c) + " of another kind");
    }
  }

  /// Marks cells that another rank owns: leaves of the point SF.
  void find_ghosts() {
    PetscSF sf = nullptr;
    check(DMGetPointSF(dm_, &sf));
    PetscInt roots = 0, leaves = 0;
    const PetscInt* points = nullptr;
    check(PetscSFGetGraph(sf, &roots, &leaves, &points, nullptr));
    for (PetscInt i = 0; i < leaves; ++i) {
      const PetscInt point = points != nullptr ? points[i] : i;
      if (cells_.has(point)) is_ghost_[static_cast<std::size_t>(point - cells_.begin)] = 1;
    }
  }

  bool is_own(PetscInt cell) const {
    return is_ghost_[static_cast<std::size_t>(cell - cells_.begin)] == 0;
  }

  /// The vertices of a point, numbered from the first one.
  template <std::size_t N>
  std::array<VertexId, N> corners_of(PetscInt point) const {
    PetscInt size = 0;
    PetscInt* closure = nullptr;
    check(DMPlexGetTransitiveClosure(dm_, point, PETSC_TRUE, &size, &closure));
    std::array<VertexId, N> corners{};
    std::size_t count = 0;
    for (PetscInt i = 0; i < size; ++i) {
      const PetscInt p = closure[static_cast<std::ptrdiff_t>(2) * i];
      if (vertices_.has(p) && count < N)
        corners[count++] = static_cast<VertexId>(p - vertices_.begin);
    }
    check(DMPlexRestoreTransitiveClosure(dm_, point, PETSC_TRUE, &size, &closure));
    return corners;
  }

  template <int Dim>
  void read_in() {
    auto& elements = meshadapt::elements_in<Dim>(result_.part.mesh);
    for (PetscInt c = cells_.begin; c < cells_.end; ++c) {
      if (!is_own(c)) continue;
      auto corners = corners_of<Dim + 1>(c);
      if (Dim == 3) std::swap(corners[0], corners[1]);  // PETSc orients them the other way
      elements.add(corners, labels_.elements.value_at(c, unlabelled));
      result_.cell_of.push_back(c);
    }
    for (const auto& corners : elements.vertices)
      for (const VertexId v : corners) local_of_[v] = 0;
    read_vertices();
    read_facets<Dim>();
    for (auto& corners : elements.vertices)
      for (VertexId& v : corners) v = local_of_[v];
  }

  /// Reads the vertices of elements and numbers them.
  void read_vertices() {
    Vec coordinates = nullptr;
    PetscSection section = nullptr;
    const PetscScalar* x = nullptr;
    check(DMGetCoordinatesLocal(dm_, &coordinates));
    check(DMGetCoordinateSection(dm_, &section));
    check(VecGetArrayRead(coordinates, &x));
    Part& part = result_.part;
    for (PetscInt v = 0; v < vertices_.size(); ++v) {
      VertexId& local = local_of_[static_cast<std::size_t>(v)];
      if (local == meshadapt::none) continue;
      local = static_cast<VertexId>(result_.point_of.size());
      result_.point_of.push_back(v);
      const PetscInt number = number_of_[v];  // negative if another rank owns it
      part.number_of.push_back(number < 0 ? -(number + 1) : number);
      part.mesh.vertex_reference.push_back(
          labels_.vertices.value_at(vertices_.begin + v, unlabelled));
      PetscInt offset = 0;
      check(PetscSectionGetOffset(section, vertices_.begin + v, &offset));
      for (int axis = 0; axis < part.mesh.dimension; ++axis)
        part.mesh.coordinates.push_back(PetscRealPart(x[offset + axis]));
    }
    check(VecRestoreArrayRead(coordinates, &x));
  }

  /// Reads labelled facets, in 3D also edges, that belong to an element of this rank.
  template <int Dim>
  void read_facets() {
    PetscInt depth = 0;
    check(DMPlexGetDepth(dm_, &depth));
    if (depth != Dim) return;  // there are no facets
    AnyMesh& mesh = result_.part.mesh;
    read_listed<Dim>(stratum_of_height(dm_, 1), labels_.facets, meshadapt::facets_in<Dim>(mesh));
    if (Dim == 3) read_listed<2>(stratum_of_height(dm_, 2), labels_.edges, mesh.edges);
  }

  template <int Corners>
  void read_listed(const Stratum& points, const CarriedLabel& label,
                   meshadapt::Cells<Corners>& cells) const {
    if (label.label == nullptr) return;
    for (PetscInt p = points.begin; p < points.end; ++p) {
      const std::int32_t value = label.value_at(p, unlabelled);
      if (value == unlabelled || !is_beside_own(p)) continue;
      auto corners = corners_of<Corners>(p);
      for (VertexId& v : corners) v = local_of_[v];
      cells.add(corners, value);
    }
  }

  bool is_beside_own(PetscInt point) const {
    PetscInt size = 0;
    PetscInt* star = nullptr;
    check(DMPlexGetTransitiveClosure(dm_, point, PETSC_FALSE, &size, &star));
    bool is_beside = false;
    for (PetscInt i = 0; i < size; ++i) {
      const PetscInt p = star[static_cast<std::ptrdiff_t>(2) * i];
      is_beside = is_beside || (cells_.has(p) && is_own(p));
    }
    check(DMPlexRestoreTransitiveClosure(dm_, point, PETSC_FALSE, &size, &star));
    return is_beside;
  }

  DM dm_;
  const CarriedLabels& labels_;
  const PetscInt* number_of_;  // [vertex]
  Stratum cells_, vertices_;
  std::vector<std::uint8_t> is_ghost_;  // [cell]
  std::vector<VertexId> local_of_;      // [vertex], in the part
  PlexPart result_;
};

}  // namespace

PlexPart read_plex(const Communicator& comm, DM dm, const CarriedLabels& labels) {
  IS numbers = nullptr;
  const PetscInt* number_of = nullptr;
  check(DMPlexGetVertexNumbering(dm, &numbers));  // owned by the DM
  check(ISGetIndices(numbers, &number_of));
  PlexPart result = comm.on_all([&] { return Reader(dm, labels, number_of).read(); });
  check(ISRestoreIndices(numbers, &number_of));
  return result;
}

}  // namespace ductile::petsc
