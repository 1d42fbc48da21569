#include "camera.hpp"

namespace ductile::cli {

namespace {

Position unit(const Position& p) { return p * (1 / norm(p)); }

}  // namespace

Camera camera_along(int axis) {
  // Seen from the front (y), from the right (x) or from above (z).
  const Position towards = unit(axis == 0   ? Position{{0.80, -0.46, 0.38}}
                                : axis == 1 ? Position{{0.46, -0.80, 0.38}}
                                            : Position{{0.38, -0.46, 0.80}});
  const Position sky{{0, 0, 1}};
  const Position right = unit(cross(sky, towards));
  return {right, cross(towards, right), towards};
}

int thinnest_axis(const AnyMesh& mesh) {
  const Box<3> box = box_of(mesh);
  const Position width = box.high - box.low;
  int thinnest = 1;
  for (const int axis : {0, 2})
    if (width[axis] < 0.8 * width[thinnest]) thinnest = axis;
  return thinnest;
}

CutPlane middle_plane(const AnyMesh& mesh, const Camera& camera, int axis) {
  const Box<3> box = box_of(mesh);
  return {axis, 0.5 * (box.low[axis] + box.high[axis]), camera.towards[axis] > 0 ? 1.0 : -1.0};
}

Tetrahedron tetrahedron(const AnyMesh& mesh, std::size_t element) {
  Tetrahedron corner;
  for (std::size_t i = 0; i < 4; ++i)
    corner[i] = position_in<3>(mesh, mesh.tetrahedra.vertices[element][i]);
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

}  // namespace ductile::cli
