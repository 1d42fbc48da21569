#include <algorithm>
#include <utility>

#include "scene.hpp"

namespace ductile::cli {

namespace {

using meshadapt::AnyMesh;

Point point(const AnyMesh& mesh, std::uint32_t vertex) {
  const double* x = &mesh.coordinates[std::size_t{vertex} * 2];
  return {x[0], x[1]};
}

/// The ends of an edge, lower first, and the reference of a triangle beside it.
using Side = std::pair<std::pair<std::uint32_t, std::uint32_t>, std::int32_t>;

std::vector<Side> all_sides(const AnyMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles.vertices[t];
    for (std::size_t i = 0; i < 3; ++i)
      sides.push_back({std::minmax(v[i], v[(i + 1) % 3]), mesh.triangles.reference[t]});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

}  // namespace

Panel panel_2d(const AnyMesh& mesh, const std::vector<Colour>& colour_of) {
  Panel panel;
  panel.faces.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& v = mesh.triangles.vertices[t];
    panel.faces.push_back(
        {{point(mesh, v[0]), point(mesh, v[1]), point(mesh, v[2])}, 3, colour_of[t]});
  }
  // Lines where a triangle has no neighbour or one of another reference, and where one is listed.
  const std::vector<Side> sides = all_sides(mesh);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool paired = i + 1 < sides.size() && sides[i].first == sides[i + 1].first;
    if (!paired || sides[i].second != sides[i + 1].second)
      panel.lines.push_back(
          {point(mesh, sides[i].first.first), point(mesh, sides[i].first.second)});
    if (paired) ++i;
  }
  for (const auto& edge : mesh.edges.vertices)
    panel.lines.push_back({point(mesh, edge[0]), point(mesh, edge[1])});
  return panel;
}

}  // namespace ductile::cli
