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

}  // namespace ductile::cli
