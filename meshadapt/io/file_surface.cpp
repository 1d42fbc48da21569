#include "file_surface.hpp"

#include <utility>

#include "ductile/meshadapt/fixed_mesh.hpp"

namespace ductile::meshadapt {

void FaceCollector::add(const NumberReader& in, std::span<const std::uint32_t> corners,
                        std::int32_t reference) {
  if (corners.size() < 3)
    in.fail("expected three corners or more, found ", corners.size(), "; correct the face");
  for (std::size_t i = 2; i < corners.size(); ++i)
    mesh.triangles.add({corners[0], corners[i - 1], corners[i]}, reference);
  cut_ += corners.size() > 3;
}

MeshWithFields FaceCollector::finish(const NumberReader& in, Warnings* warnings) {
  if (mesh.triangles.size() == 0) in.fail("expected faces, found none; write the file again");
  mesh.vertex_reference.assign(mesh.coordinates.size() / 3, 0);
  if (cut_ > 0)
    warn(warnings, mesh.name + ": " + std::to_string(cut_) +
                       " faces of more than three corners were cut into triangles");
  return meshadapt::finish({std::move(mesh), {}, {}, {}}, warnings);
}

FileSurface surface_of(const AnyMesh& mesh, const std::filesystem::path& path,
                       const WriteOptions& options) {
  if (mesh.dimension != 3)
    throw InputError(path.string() +
                     ": expected a mesh of dimension 3, whose surface goes there, found one of "
                     "dimension 2; write another format");
  if (mesh.tetrahedra.size() == 0) return {mesh.coordinates, mesh.triangles};
  warn_of_lost(options, path, "references and the inside");
  const auto fixed = make_fixed_mesh<3>(runtime::Executor({.threads = 1}), mesh);
  FileSurface surface;
  std::vector<std::uint32_t> number_of(mesh.vertex_count(), none);
  const auto number = [&](VertexId v) {
    if (number_of[v] == none) {
      number_of[v] = static_cast<std::uint32_t>(surface.coordinates.size() / 3);
      surface.coordinates.insert(surface.coordinates.end(), &mesh.coordinates[3 * std::size_t{v}],
                                 &mesh.coordinates[3 * std::size_t{v}] + 3);
    }
    return number_of[v];
  };
  for (std::size_t element = 0; element < fixed.element_count(); ++element)
    for (int i = 0; i < 4; ++i) {
      if (fixed.neighbour_of[element][static_cast<std::size_t>(i)] != none) continue;
      Facet<3> side = facet_of<3>(fixed.corners_of[element], i);
      for (VertexId& v : side) v = number(v);
      surface.triangles.add(side, 0);
    }
  return surface;
}

}  // namespace ductile::meshadapt
