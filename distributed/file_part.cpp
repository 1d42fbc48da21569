#include "distributed/file_part.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "distributed/listed.hpp"
#include "geometry/marked_points.hpp"

namespace ductile::distributed {

namespace {

/// Gives required entities their own labels, one for each reference.
std::vector<KeptReference> mark_required(std::vector<std::int32_t>& reference_of,
                                         std::vector<std::uint32_t>& required,
                                         const std::string& name) {
  std::vector<KeptReference> kept;
  if (required.empty()) return kept;
  std::map<std::int32_t, std::int32_t> label_of;  // [reference]
  const std::int32_t largest = *std::max_element(reference_of.begin(), reference_of.end());
  if (largest > std::numeric_limits<std::int32_t>::max() - static_cast<int>(required.size()))
    throw meshadapt::InputError(name + ": expected references of what is required that leave " +
                                std::to_string(required.size()) + " above them, found " +
                                std::to_string(largest));
  for (const std::uint32_t i : std::set(required.begin(), required.end())) {
    const auto [at, is_new] = label_of.try_emplace(
        reference_of[i], largest + 1 + static_cast<std::int32_t>(label_of.size()));
    if (is_new) kept.push_back({at->second, at->first});
    reference_of[i] = at->second;
  }
  required.clear();
  return kept;
}

/// Marks vertices to be kept by their index in the result.
std::vector<KeptVertex> mark_kept(AnyMesh& mesh, meshadapt::Warnings& warnings) {
  std::vector<KeptVertex> kept;
  const std::vector<std::uint8_t> is_point = meshadapt::marked_points(mesh);
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
  for (VertexId v = 0; v < before.size(); ++v)
    if (is_point[v] != 0 && keep(v).is_required == 0) keep(v).is_corner = 1;
  std::size_t lost = 0;
  for (VertexId v = 0; v < before.size(); ++v)
    lost += before[v] != 0 && mesh.vertex_reference[v] == unlabelled ? 1 : 0;
  if (lost > 0)
    warnings.push_back(mesh.name + ": references of " + std::to_string(lost) +
                       " vertices that are not required are left out");
  return kept;
}

/// Removes listed edges that belong to no tetrahedron, as adapt() does: no part would have them.
void drop_loose_edges(const runtime::Executor& executor, AnyMesh& mesh,
                      meshadapt::Warnings& warnings) {
  if (mesh.dimension != 3 || mesh.edges.size() == 0) return;
  const auto around = elements_around<3>(executor, mesh);
  const std::vector<Marks> marks = marks_of(mesh, mesh.edges);
  const auto all = std::exchange(mesh.edges, {});
  mesh.ridges.clear();
  mesh.required_edges.clear();
  std::size_t first = all.size();  // the first loose one
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool is_loose = true;
    visit_beside<3>(mesh, around, all.vertices[i], [&](std::uint32_t) { is_loose = false; });
    if (!is_loose)
      list(mesh, all.vertices[i], all.reference[i], marks[i]);
    else
      first = std::min(first, i);
  }
  if (const std::size_t loose = all.size() - mesh.edges.size(); loose > 0)
    warnings.push_back(
        mesh.name + ": " + std::to_string(loose) + " of " + std::to_string(all.size()) +
        " listed edges belong to no tetrahedron and are left out; the first is edge " +
        std::to_string(first + 1));
}

}  // namespace

FilePart part_of_file(const runtime::Executor& executor, AnyMesh mesh, AnyField metric,
                      meshadapt::Warnings& warnings) {
  drop_loose_edges(executor, mesh, warnings);
  const bool is_flat = mesh.dimension == 2;
  FilePart result{empty_part(mesh.dimension), {}};
  result.kept.vertices = mark_kept(mesh, warnings);
  result.kept.names = std::exchange(mesh.names, {});
  result.kept.dropped_axis = mesh.dropped_axis;
  result.kept.facets =
      is_flat ? mark_required(mesh.edges.reference, mesh.required_edges, mesh.name)
              : mark_required(mesh.triangles.reference, mesh.required_triangles, mesh.name);
  result.kept.elements =
      is_flat ? mark_required(mesh.triangles.reference, mesh.required_triangles, mesh.name)
              : mark_required(mesh.tetrahedra.reference, mesh.required_tetrahedra, mesh.name);
  mesh.corners.clear();
  mesh.required_vertices.clear();
  Part& part = result.part;
  part.number_of.resize(mesh.vertex_count());
  std::iota(part.number_of.begin(), part.number_of.end(), std::int64_t{0});
  part.mesh = std::move(mesh);
  part.wanted = std::move(metric);
  return result;
}

std::vector<std::uint32_t> restore_references(std::vector<std::int32_t>& reference_of,
                                              const std::vector<KeptReference>& kept) {
  std::vector<std::uint32_t> required;
  if (kept.empty()) return required;
  for (std::uint32_t i = 0; i < reference_of.size(); ++i) {
    if (reference_of[i] < kept.front().label) continue;
    reference_of[i] =
        kept[static_cast<std::size_t>(reference_of[i] - kept.front().label)].reference;
    required.push_back(i);
  }
  return required;
}

AnyMesh mesh_for_file(const Part& part, const Kept& kept) {
  AnyMesh mesh = part.mesh;
  mesh.names = kept.names;
  mesh.dropped_axis = kept.dropped_axis;
  for (VertexId v = 0; v < mesh.vertex_count(); ++v) {
    std::int32_t& reference = mesh.vertex_reference[v];
    if (reference == unlabelled) {
      reference = 0;
      continue;
    }
    const KeptVertex& vertex = kept.vertices[static_cast<std::size_t>(reference)];
    reference = vertex.reference;
    if (vertex.is_required != 0) mesh.required_vertices.push_back(v);
    if (vertex.is_corner != 0) mesh.corners.push_back(v);
  }
  if (mesh.dimension == 2) {
    drop_unlabelled<2>(mesh);
    mesh.required_edges = restore_references(mesh.edges.reference, kept.facets);
    mesh.required_triangles = restore_references(mesh.triangles.reference, kept.elements);
  } else {
    drop_unlabelled<3>(mesh);
    mesh.required_triangles = restore_references(mesh.triangles.reference, kept.facets);
    mesh.required_tetrahedra = restore_references(mesh.tetrahedra.reference, kept.elements);
  }
  return mesh;
}

}  // namespace ductile::distributed
