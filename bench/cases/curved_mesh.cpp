#include "cases/curved_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::bench {

using meshadapt::AnyMesh;

AnyMesh curved_mesh(int dimension, int cells) {
  const int across = std::max(1, cells / 4);
  AnyMesh mesh = dimension == 2 ? meshadapt::box_mesh<2>({0.5, 2}, {across, cells})
                                : meshadapt::box_mesh({0.5, 2, 2}, {across, cells, cells});
  const auto stride = static_cast<std::size_t>(dimension);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += stride) {
    double* place = &mesh.coordinates[at];
    const double radius = place[0] + 0.5, longitude = place[1] - 1;
    const double latitude = dimension == 2 ? 0 : place[2] - 1;
    place[0] = radius * std::cos(longitude) * std::cos(latitude);
    place[1] = radius * std::sin(longitude) * std::cos(latitude);
    if (dimension == 3) place[2] = radius * std::sin(latitude);
  }
  return mesh;
}

}  // namespace ductile::bench
