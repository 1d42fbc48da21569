#include "file_part.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace ductile::petsc {

namespace {

void refuse_required(const AnyMesh& mesh) {
  const bool edges = !mesh.required_edges.empty(), triangles = !mesh.required_triangles.empty();
  if (!edges && !triangles && mesh.required_tetrahedra.empty()) return;
  const std::string what = edges ? "edges" : triangles ? "triangles" : "tetrahedra";
  throw meshadapt::InputError(
      mesh.name + ": expected no required " + what +
      ", which are not kept on several ranks, found some; use ductile adapt");
}

/// Marks vertices that stay by their index in what is returned.
std::vector<KeptVertex> mark_kept(AnyMesh& mesh, meshadapt::Warnings& warnings) {
  std::vector<KeptVertex> kept;
  const auto before = std::exchange(mesh.vertex_reference, {});
  mesh.vertex_reference.assign(before.size(), unlabelled);
  const auto keep = [&](VertexId v) -> KeptVertex& {
    std::int32_t& label = mesh.vertex_reference[v];
    if (label == unlabelled) {
      label = static_cast<std::int32_t>(kept.size());
      kept.push_back({before[v], 0, 0});
    }
    return kept[static_cast<std::size_t>(label)];
  };
  for (const VertexId v : mesh.required_vertices) keep(v).is_required = 1;
  for (const VertexId v : mesh.corners) keep(v).is_corner = 1;
  std::size_t lost = 0;
  for (VertexId v = 0; v < before.size(); ++v)
    lost += before[v] != 0 && mesh.vertex_reference[v] == unlabelled ? 1 : 0;
  if (lost > 0)
    warnings.push_back(mesh.name + ": references of " + std::to_string(lost) +
                       " vertices that are not required are left out");
  return kept;
}

}  // namespace

FilePart part_of_file(AnyMesh mesh, AnyField metric, meshadapt::Warnings& warnings) {
  refuse_required(mesh);
  if (mesh.dimension == 3 && mesh.edges.size() > 0)
    warnings.push_back(mesh.name + ": its " + std::to_string(mesh.edges.size()) +
                       " edges are left out, which are not kept on several ranks");
  FilePart result{empty_part(mesh.dimension), mark_kept(mesh, warnings)};
  mesh.corners.clear();
  mesh.ridges.clear();
  mesh.required_vertices.clear();
  mesh.names.clear();
  if (mesh.dimension == 3) mesh.edges = {};
  Part& part = result.part;
  part.number_of.resize(mesh.vertex_count());
  std::iota(part.number_of.begin(), part.number_of.end(), std::int64_t{0});
  part.mesh = std::move(mesh);
  part.wanted = std::move(metric);
  return result;
}

AnyMesh mesh_for_file(const Part& part, const std::vector<KeptVertex>& kept) {
  AnyMesh mesh = part.mesh;
  for (VertexId v = 0; v < mesh.vertex_count(); ++v) {
    std::int32_t& reference = mesh.vertex_reference[v];
    if (reference == unlabelled) {
      reference = 0;
      continue;
    }
    const KeptVertex& vertex = kept[static_cast<std::size_t>(reference)];
    reference = vertex.reference;
    if (vertex.is_required != 0) mesh.required_vertices.push_back(v);
    if (vertex.is_corner != 0) mesh.corners.push_back(v);
  }
  const auto drop_unlabelled = [](auto& cells) {
    const auto all = std::exchange(cells, {});
    for (std::size_t c = 0; c < all.size(); ++c)
      if (all.reference[c] != unlabelled) cells.add(all.vertices[c], all.reference[c]);
  };
  if (mesh.dimension == 2)
    drop_unlabelled(mesh.edges);
  else
    drop_unlabelled(mesh.triangles);
  return mesh;
}

}  // namespace ductile::petsc
