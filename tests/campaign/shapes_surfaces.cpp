#include "geometry.hpp"
#include "place.hpp"
#include "shapes.hpp"

namespace ductile::campaign {
namespace {

Mesh body_in_space(Random& random) {
  for (;;) {
    const int way = random.below(5);
    Mesh mesh = (way == 0   ? random_body(random)
                 : way == 1 ? thin_wall(random)
                 : way == 2 ? inclusion(random)
                 : way == 3 ? plate_with_voids(random)
                            : round_body(random))
                    .mesh;
    if (mesh.dimension == 3 && all_positive(mesh)) return mesh;
  }
}

}  // namespace

Shape bare_surface(Random& random) {
  Shape shape;
  shape.curved = true;
  Mesh& mesh = shape.mesh = body_in_space(random);
  choose_regions(random, mesh);
  list_all_facets(random.bits(), mesh);
  mesh.point_reference.assign(mesh.points.size(), 0);
  const double lost = random.chance(0.4) ? random.pick({0.003, 0.03, 0.3}) : 0;
  make_surface(mesh, [&] { return !random.chance(lost); });
  const double noise = random.chance(0.4) ? random.power(-4, -2) : 0;
  for (Point& point : mesh.points)
    for (double& x : point) x += noise * random.uniform(-1, 1);
  const double turned = random.chance(0.2) ? 0.1 : 0;
  for (Cell& triangle : mesh.elements().corners)
    if (random.chance(turned)) std::swap(triangle[0], triangle[1]);
  return shape;
}

}  // namespace ductile::campaign
