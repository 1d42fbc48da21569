#include "section.hpp"

#include <algorithm>
#include <limits>

namespace ductile::cli {

CutPlane middle_plane(const meshadapt::AnyMesh& mesh, const Camera& camera, int axis) {
  const Span span = span_along(mesh, axis);
  return {axis, 0.5 * (span.from + span.to), camera.towards[axis] > 0 ? 1.0 : -1.0};
}

Tetrahedron tetrahedron(const meshadapt::AnyMesh& mesh, std::size_t element) {
  Tetrahedron corner;
  for (std::size_t i = 0; i < 4; ++i)
    corner[i] = meshadapt::position_in<3>(mesh, mesh.tetrahedra.vertices[element][i]);
  return corner;
}

std::vector<Position> section(const Tetrahedron& corner, const CutPlane& plane) {
  std::vector<Position> behind, before;
  for (const Position& p : corner) (plane.side(p) < 0 ? behind : before).push_back(p);
  if (behind.empty() || before.empty()) return {};
  const auto between = [&](const Position& a, const Position& b) {
    return a + (plane.side(a) / (plane.side(a) - plane.side(b))) * (b - a);
  };
  if (behind.size() == 2)
    return {between(behind[0], before[0]), between(behind[0], before[1]),
            between(behind[1], before[1]), between(behind[1], before[0])};
  const Position& apex = behind.size() == 1 ? behind[0] : before[0];
  std::vector<Position> triangle;
  for (const Position& p : behind.size() == 1 ? before : behind)
    triangle.push_back(between(p, apex));
  return triangle;
}

Span span_along(const meshadapt::AnyMesh& mesh, int axis) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Span span{infinity, -infinity};
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t i = static_cast<std::size_t>(axis); i < mesh.coordinates.size();
       i += dimension) {
    span.from = std::min(span.from, mesh.coordinates[i]);
    span.to = std::max(span.to, mesh.coordinates[i]);
  }
  return span;
}

}  // namespace ductile::cli
