#include "support/ball_in_box.hpp"

#include <algorithm>
#include <cmath>

#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

AnyMesh ball_in_box(int dimension, int n, double radius) {
  Grid grid = unit_grid(dimension, n);
  grid.region = [=](const Cell& cell) {
    bool inside = true;
    for (int i = 0; i < dimension; ++i) {
      const int at = cell[static_cast<std::size_t>(i)];
      inside = inside && 4 * at >= n && 4 * at < 3 * n;
    }
    return inside ? ball_inside : ball_outside;
  };
  AnyMesh mesh = make_grid(grid);
  auto& references = dimension == 2 ? mesh.edges.reference : mesh.triangles.reference;
  for (auto& reference : references)
    if (reference > 10) reference = ball_interface;
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    double* const x = &mesh.coordinates[d * v];
    double most = 0, square = 0;
    for (std::size_t k = 0; k < d; ++k) {
      x[k] = 2 * x[k] - 1;
      most = std::max(most, std::abs(x[k]));
      square += x[k] * x[k];
    }
    if (!(square > 0)) continue;
    // Cubes of half the extent `most` become balls up to 1/2; from there on, cubes again.
    const double out = std::max(0.0, 2 * most - 1);
    const double round = 2 * radius * std::min(most, 0.5) / std::sqrt(square);
    const double scale = (1 - out) * round + out;
    for (std::size_t k = 0; k < d; ++k) x[k] *= scale;
  }
  return mesh;
}

std::set<std::uint32_t> interface_vertices(const AnyMesh& mesh) {
  std::set<std::uint32_t> found;
  const auto add = [&](const auto& facets) {
    for (std::size_t f = 0; f < facets.size(); ++f)
      if (facets.reference[f] == ball_interface)
        found.insert(facets.vertices[f].begin(), facets.vertices[f].end());
  };
  mesh.dimension == 2 ? add(mesh.edges) : add(mesh.triangles);
  return found;
}

}  // namespace ductile::meshadapt::test
