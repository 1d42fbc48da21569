#include "support/short_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ductile/meshadapt/metric_field.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

namespace {

using Edge = std::array<std::uint32_t, 2>;

/// Splits all cells at an edge in two, at the new vertex `middle`.
template <int Corners>
void cut(Cells<Corners>& cells, const Edge& edge, std::uint32_t middle) {
  const std::size_t count = cells.size();
  for (std::size_t c = 0; c < count; ++c) {
    auto& corners = cells.vertices[c];
    const auto a = std::find(corners.begin(), corners.end(), edge[0]);
    const auto b = std::find(corners.begin(), corners.end(), edge[1]);
    if (a == corners.end() || b == corners.end()) continue;
    auto half = corners;
    half[static_cast<std::size_t>(a - corners.begin())] = middle;
    *b = middle;
    cells.add(half, cells.reference[c]);
  }
}

/// Splits an edge of the mesh at this share of its length from its first end.
void split(AnyMesh& mesh, const Edge& edge, double share) {
  const auto middle = static_cast<std::uint32_t>(mesh.vertex_count());
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const double from = mesh.coordinates[edge[0] * dimension + axis];
    const double to = mesh.coordinates[edge[1] * dimension + axis];
    mesh.coordinates.push_back(from + share * (to - from));
  }
  mesh.vertex_reference.push_back(0);
  cut(mesh.edges, edge, middle);
  cut(mesh.triangles, edge, middle);
  cut(mesh.tetrahedra, edge, middle);
}

/// The facets that face down.
template <int Dim>
std::vector<std::uint32_t> bottom_of(const AnyMesh& mesh) {
  std::vector<std::uint32_t> bottom;
  const auto& facets = facets_in<Dim>(mesh);
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    if (facets.reference[f] == 2 * Dim - 1) bottom.push_back(f);
  return bottom;
}

template <int Dim>
void make_in(ShortEdgeCase& made, Random& random) {
  AnyMesh& mesh = made.mesh;
  const std::size_t count = 1 + below(random, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const auto bottom = bottom_of<Dim>(mesh);
    const auto& facet = facets_in<Dim>(mesh).vertices[bottom[below(random, bottom.size())]];
    const std::size_t first = below(random, Dim), second = (first + 1) % Dim;
    const double share = std::pow(10.0, -uniform(random, 2, 6));
    split(mesh, {facet[first], facet[second]}, share);
    made.what += ", one of " + std::to_string(share);
  }
  (Dim == 2 ? mesh.required_edges : mesh.required_triangles) = bottom_of<Dim>(mesh);
}

}  // namespace

ShortEdgeCase short_edge_case(int dimension, std::uint64_t seed) {
  Random random(seed * 0x9e3779b97f4a7c15U + 7);
  random.discard(10);
  const int n = dimension == 2 ? 5 + static_cast<int>(below(random, 10))
                               : 3 + static_cast<int>(below(random, 4));
  Grid grid = unit_grid(dimension, n);
  if (chance(random, 0.5)) grid.seed = random();
  ShortEdgeCase made;
  made.mesh = make_grid(grid);
  made.what = std::to_string(dimension) + "D, " + std::to_string(n) + " edges in a row";
  if (chance(random, 0.3)) jiggle(made.mesh, random, 0.2);
  dimension == 2 ? make_in<2>(made, random) : make_in<3>(made, random);
  const double size = (chance(random, 0.3) ? 1.001 : uniform(random, 1, 1.4)) / n;
  made.metric = constant_metric(made.mesh, size);
  made.what += ", size " + std::to_string(size * n) + " of theirs";
  return made;
}

}  // namespace ductile::meshadapt::test
