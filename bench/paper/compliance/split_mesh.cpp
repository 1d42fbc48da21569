#include "split_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace ductile::paper {

using meshadapt::AnyMesh;

namespace {

using Edge = std::array<std::uint32_t, 2>;

Edge ordered(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Each edge of the triangles once, in order.
std::vector<Edge> edges_of(const AnyMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles.vertices)
    edges.insert(edges.end(), {ordered(a, b), ordered(b, c), ordered(c, a)});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

AnyMesh split_in_four(const AnyMesh& mesh) {
  const std::vector<Edge> edges = edges_of(mesh);
  const auto old_vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto at = std::lower_bound(edges.begin(), edges.end(), ordered(a, b));
    return old_vertices + static_cast<std::uint32_t>(at - edges.begin());
  };
  AnyMesh fine;
  fine.dimension = 2;
  fine.name = mesh.name + ", split";
  fine.coordinates = mesh.coordinates;
  fine.vertex_reference = mesh.vertex_reference;
  for (const auto [a, b] : edges) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      fine.coordinates.push_back((mesh.coordinates[2 * a + axis] + mesh.coordinates[2 * b + axis]) /
                                 2);
    fine.vertex_reference.push_back(0);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles.vertices[t];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& corners : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      fine.triangles.add(corners, mesh.triangles.reference[t]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const auto [a, b] = mesh.edges.vertices[e];
    fine.edges.add({a, middle(a, b)}, mesh.edges.reference[e]);
    fine.edges.add({middle(a, b), b}, mesh.edges.reference[e]);
  }
  return fine;
}

}  // namespace ductile::paper
