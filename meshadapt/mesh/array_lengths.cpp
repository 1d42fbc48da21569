#include "mesh/array_lengths.hpp"

#include <string>

#include "ductile/meshadapt/error.hpp"

namespace ductile::meshadapt {
namespace {

template <int Corners>
void expect_references_of(const AnyMesh& mesh, const Cells<Corners>& cells, const char* kind) {
  if (cells.reference.size() != cells.size())
    throw InputError(mesh.name + ": expected a reference for each of the " +
                     std::to_string(cells.size()) + " " + kind + ", found " +
                     std::to_string(cells.reference.size()));
}

}  // namespace

void expect_coordinates(const AnyMesh& mesh) {
  const std::string dimension = std::to_string(mesh.dimension);
  if (mesh.dimension != 2 && mesh.dimension != 3)
    throw InputError(mesh.name + ": expected dimension 2 or 3, found " + dimension);
  const std::size_t places = mesh.coordinates.size() / static_cast<std::size_t>(mesh.dimension);
  if (places > mesh.vertex_count())
    throw InputError(mesh.name + ": expected a reference in vertex_reference for each of the " +
                     std::to_string(places) + " vertices that have coordinates, found " +
                     std::to_string(mesh.vertex_count()));
  if (mesh.coordinates.size() != static_cast<std::size_t>(mesh.dimension) * mesh.vertex_count())
    throw InputError(mesh.name + ": expected " + dimension + " coordinates for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices, found " +
                     std::to_string(mesh.coordinates.size()) + " numbers");
}

void expect_references(const AnyMesh& mesh) {
  expect_references_of(mesh, mesh.edges, "edges");
  expect_references_of(mesh, mesh.triangles, "triangles");
  expect_references_of(mesh, mesh.tetrahedra, "tetrahedra");
}

void expect_values(const AnyField& field) {
  const std::size_t expected = field.vertex_count * stride_of(field);
  if (field.values.size() != expected)
    throw InputError(field.name + ": expected " + std::to_string(expected) + " values, found " +
                     std::to_string(field.values.size()));
}

}  // namespace ductile::meshadapt
