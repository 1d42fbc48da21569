#include "mesh/array_lengths.hpp"

#include <string>

#include "ductile/meshadapt/error.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {
namespace {

template <int Corners>
void expect_references_of(const AnyMesh& mesh, const Cells<Corners>& cells, const char* kind) {
  if (cells.reference.size() != cells.size())
    throw InputError(name_of(mesh) + ": expected a reference for each of the " +
                     std::to_string(cells.size()) + " " + kind + ", found " +
                     std::to_string(cells.reference.size()) + " in " + kind + ".reference");
}

}  // namespace

void expect_coordinates(const AnyMesh& mesh) {
  const std::string dimension = std::to_string(mesh.dimension);
  if (mesh.dimension != 2 && mesh.dimension != 3)
    throw InputError(name_of(mesh) + ": expected dimension 2 or 3, found " + dimension);
  const std::size_t places = mesh.coordinates.size() / static_cast<std::size_t>(mesh.dimension);
  if (places > mesh.vertex_count())
    throw InputError(name_of(mesh) + ": expected a reference in vertex_reference for each of the " +
                     std::to_string(places) + " vertices that have coordinates, found " +
                     std::to_string(mesh.vertex_count()));
  if (mesh.coordinates.size() != static_cast<std::size_t>(mesh.dimension) * mesh.vertex_count())
    throw InputError(name_of(mesh) + ": expected " + dimension + " coordinates for each of the " +
                     std::to_string(mesh.vertex_count()) + " vertices, found " +
                     std::to_string(mesh.coordinates.size()) + " numbers in coordinates");
}

void expect_references(const AnyMesh& mesh) {
  expect_references_of(mesh, mesh.edges, "edges");
  expect_references_of(mesh, mesh.triangles, "triangles");
  expect_references_of(mesh, mesh.tetrahedra, "tetrahedra");
}

void expect_values(const AnyField& field) {
  if (field.dimension != 2 && field.dimension != 3)
    throw InputError(name_of(field) + ": expected dimension 2 or 3, found " +
                     std::to_string(field.dimension));
  if (field.types.empty()) throw InputError(name_of(field) + ": expected a type in types[0]");
  for (std::size_t i = 0; i < field.types.size(); ++i)
    if (const int type = static_cast<int>(field.types[i]); type < 1 || type > 4)
      throw InputError(name_of(field) + ": expected a type from 1 to 4 in types[" +
                       std::to_string(i) + "], found " + std::to_string(type));
  const std::size_t stride = stride_of(field), found = field.values.size();
  if (found / stride != field.vertex_count || found % stride != 0)
    throw InputError(name_of(field) + ": expected numbers for all components at all vertices, " +
                     std::to_string(stride * field.vertex_count) + " of them, found " +
                     std::to_string(found) + " in values");
}

}  // namespace ductile::meshadapt
